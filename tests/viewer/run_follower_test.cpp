#include "viewer/run_follower.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <thread>

#include "lcmtypes/rejected_message.h"
#include "logger/recovered_run.h"
#include "mapper/mapper_config.h"
#include "sensor_sim/scan.h"
#include "tests/planner/boxes_run.h"
#include "tests/viewer/page_model.h"
#include "viewer/run_source.h"

namespace nextview {
namespace {

constexpr const char* kLog = NEXTVIEW_SOURCE_DIR "/tests/logger/fixtures/surface-1.lcmlog";

std::int8_t in_127ths(double component) {
  return static_cast<std::int8_t>(std::lround(127.0 * component));
}

/// The surface voxels of a map, one by one.
std::map<std::array<int, 3>, PageModel::Voxel> surface_of(const VoxelMap& map) {
  std::map<std::array<int, 3>, PageModel::Voxel> voxels;
  for_each_voxel(map.window(), [&](const VoxelIndex& at) {
    const std::array<int, 3> index = {at[0], at[1], at[2]};
    if (map.label(at) == Label::OcclusionPlane) voxels[index] = {true, {0, 0, 0}, 0};
    if (map.label(at) != Label::Occupied) return;
    const SurfaceVoxel* surface = map.surface(at);
    ASSERT_NE(surface, nullptr);
    const Eigen::Vector3d normal = surface->mean_normal();
    voxels[index] = {false,
                     {in_127ths(normal.x()), in_127ths(normal.y()), in_127ths(normal.z())},
                     static_cast<std::uint8_t>(std::lround(255.0 * surface->quality_01()))};
  });
  return voxels;
}

TEST(RunFollower, GivesEveryViewAsTheMapperHasIt) {
  std::deque<ServedRun> runs;
  runs.emplace_back("a log");
  follow_log(kLog, runs[0].viewed, {});
  const RecoveredRun recovered = recover_run(kLog);
  const int views = static_cast<int>(recovered.images.size());
  ASSERT_GT(views, 3);
  ASSERT_EQ(runs[0].viewed.views(), views);

  Outbox outbox(runs);
  PageModel page;
  MapBuilder builder(grid_of(recovered.config()), window_of(recovered.config()));
  for (int view = 1; view <= views; ++view) {
    const ReceivedRangeImage& received = *recovered.images[static_cast<std::size_t>(view - 1)];
    builder.fold(received.image);
    outbox.take(R"({"show": 0, "view": )" + std::to_string(view) + "}", nobody);
    page.drain(outbox);
    ASSERT_EQ(page.view, view);
    EXPECT_EQ(page.scan_view, view);
    const auto shown = page.voxels();
    EXPECT_EQ(shown, surface_of(builder.map())) << "view " << view;
    const commit_t& commit = *recovered.log.record().commit(view);
    const auto planes = std::count_if(shown.begin(), shown.end(),
                                      [](const auto& voxel) { return voxel.second.plane; });
    EXPECT_EQ(planes, commit.occlusion_plane_voxels);
    EXPECT_EQ(static_cast<std::int64_t>(shown.size()) - planes, commit.occupied_voxels);
    const auto& row = page.rows.at(static_cast<std::size_t>(view - 1));
    EXPECT_EQ(row.at("digest"), commit.map_digest);
    EXPECT_EQ(row.at("same_digest"), true);
    EXPECT_EQ(row.at("area_m2"), commit.occupied_area_m2);
    if (view < views) {
      const search_t& search = *recovered.log.record().search(
          view + 1, recovered.log.record().commit(view + 1)->attempt);
      EXPECT_EQ(page.tried, static_cast<std::uint32_t>(search.tried));
      EXPECT_EQ(page.next.at("view"), view + 1);
    }
  }
  EXPECT_EQ(page.facts.at("stop").at("reason"), recovered.log.record().stop()->stop_reason);

  // And back again.
  outbox.take(R"({"show": 0, "view": 2})", nobody);
  page.drain(outbox);
  MapBuilder first_two(grid_of(recovered.config()), window_of(recovered.config()));
  for (int i = 0; i < 2; ++i) first_two.fold(recovered.images[static_cast<std::size_t>(i)]->image);
  EXPECT_EQ(page.voxels(), surface_of(first_two.map()));
  outbox.take(R"({"show": 0, "view": 0})", nobody);
  page.drain(outbox);
  EXPECT_TRUE(page.voxels().empty());
}

TEST(RunFollower, OfALogThatEndsInTheMiddleGoesOnWhenItGrows) {
  const auto file = std::filesystem::path(testing::TempDir()) / "nextview-viewer-growing.lcmlog";
  std::filesystem::copy_file(kLog, file, std::filesystem::copy_options::overwrite_existing);
  const auto whole = std::filesystem::file_size(file);
  std::filesystem::resize_file(file, whole / 2);
  ViewedRun viewed("a growing log");
  std::jthread follower(
      [&](const std::stop_token& stop) { follow_log(file.string(), viewed, stop); });
  while (viewed.facts().json.find("no end of the run yet") == std::string::npos) {
    std::this_thread::yield();
  }
  const int before = viewed.views();
  EXPECT_GT(before, 0);
  std::filesystem::copy_file(kLog, file, std::filesystem::copy_options::overwrite_existing);
  follower.join();
  EXPECT_GT(viewed.views(), before);
  EXPECT_EQ(viewed.views(), static_cast<int>(recover_run(kLog).images.size()));
  std::filesystem::remove(file);
}

TEST(RunFollower, TakesAViewsMessagesInAnyOrder) {
  const RecoveredRun recovered = recover_run(kLog);
  const RunRecord& record = recovered.log.record();
  const commit_t& commit = *record.commit(1);
  for (int last = 0; last < 4; ++last) {
    ViewedRun viewed("a run");
    RunFollower follower(viewed);
    follower.add(recovered.config());
    for (int turn = 1; turn <= 4; ++turn) {
      EXPECT_EQ(viewed.views(), 0);
      switch ((last + turn) % 4) {
        case 0:
          follower.add(*record.goal(1, commit.attempt));
          break;
        case 1:
          follower.add(*record.arrival(1, commit.attempt));
          break;
        case 2:
          for (range_image_t& part :
               range_image_messages(recovered.images[0]->image, 1, commit.attempt, 0)) {
            part.run = recovered.config().run;
            follower.add(part);
          }
          break;
        default:
          follower.add(commit);
      }
    }
    EXPECT_EQ(viewed.views(), 1) << "the last was " << last;
  }
}

TEST(RunFollower, LeavesOutWhatDoesNotFitTheRun) {
  ViewedRun viewed("a run");
  RunFollower follower(viewed);
  const run_config_t config = example<run_config_t>();
  follower.add(config);
  commit_t commit = example<commit_t>();
  commit.view = config.planner.max_views + 1;
  EXPECT_THROW(follower.add(commit), RejectedMessage);
  goal_t goal = example<goal_t>();
  goal.attempt = config.planner.max_attempts + 1;
  EXPECT_THROW(follower.add(goal), RejectedMessage);
  EXPECT_FALSE(follower.waits());
}

/// 2000 views from places all over the room "boxes".
TEST(RunFollower, OfTwoThousandViewsKeepsLittleInMemory) {
  constexpr int kViews = 2000;
  run_config_t config = boxes_run_config();
  config.planner.max_views = kViews;
  const Scene scene(load_mesh(config.scene_file));
  const RayTable rays = make_ray_table(TiltedLineScan::with_aperture(24, 12, 1.0));
  std::deque<ServedRun> runs;
  runs.emplace_back("2000 views");
  ViewedRun& viewed = runs[0].viewed;
  RunFollower follower(viewed);
  follower.add(config);
  MapBuilder builder(grid_of(config), window_of(config));
  for (int view = 1; view <= kViews; ++view) {
    SensorPose pose;
    pose.position_m = {0.7 + 0.0001 * view, 1.0, 1.2};
    pose.pan_rad = 0.7 * view;
    pose.tilt_rad = 0.5 * std::sin(0.3 * view);
    RangeImage image;
    image.pose = pose;
    image.position_m = pose.position_m;
    image.world_from_sensor = world_from_sensor_rotation(pose.pan_rad, pose.tilt_rad);
    image.rays = rays;
    for (int v = 0; v < rays.rows(); ++v) {
      for (int u = 0; u < rays.columns(); ++u) {
        const auto hit = scene.first_hit(pose.position_m, image.world_from_sensor * rays.ray(u, v));
        image.range_m.push_back(hit ? quantise_range(static_cast<double>(hit->distance_m))
                                    : std::numeric_limits<float>::infinity());
      }
    }
    builder.fold(image);
    goal_t goal = example<goal_t>();
    arrival_t arrival = example<arrival_t>();
    commit_t commit = example<commit_t>();
    goal.view = arrival.view = commit.view = view;
    arrival.arrived = 1;
    commit.map_digest = builder.digest();
    commit.occupied_voxels = builder.statistics().voxels[static_cast<std::size_t>(Label::Occupied)];
    follower.add(goal);
    follower.add(arrival);
    for (range_image_t& part : range_image_messages(image, view, 1, 0)) {
      part.run = config.run;
      follower.add(part);
    }
    follower.add(commit);
  }
  ASSERT_EQ(viewed.views(), kViews);
  // 1 KB of table and where 12 changed blocks lie: this sensor's view of the room changes no more.
  EXPECT_LT(viewed.memory_bytes(), kViews * 2048U);
  RecordProperty("memory_bytes", static_cast<int>(viewed.memory_bytes()));
  RecordProperty("file_bytes", static_cast<int>(viewed.file_bytes()));

  Outbox outbox(runs);
  PageModel page;
  outbox.take(R"({"show": 0, "view": null})", nobody);
  page.drain(outbox);
  EXPECT_EQ(page.view, kViews);
  EXPECT_EQ(page.rows.size(), static_cast<std::size_t>(kViews));
  EXPECT_TRUE(std::all_of(page.rows.begin(), page.rows.end(),
                          [](const auto& row) { return row.at("same_digest") == true; }));
  EXPECT_EQ(page.voxels(), surface_of(builder.map()));
}

}  // namespace
}  // namespace nextview
