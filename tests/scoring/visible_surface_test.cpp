#include "scoring/visible_surface.h"

#include <gtest/gtest.h>

#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <thread>

#include "scene/scene_catalog.h"
#include "scoring/coverage_unknown.h"
#include "scoring/position_tree.h"
#include "scoring/surface_samples.h"
#include "tests/scoring/room_mesh.h"

namespace nextview {
namespace {

namespace fs = std::filesystem;

VisibilityParameters all_of(const Eigen::Vector3d& size) {
  VisibilityParameters parameters;
  parameters.reach.box_max_m = size;
  return parameters;
}

TEST(VisibleSurface, IsAllOfAnEmptyRoom) {
  const Eigen::Vector3d size(3.0, 2.0, 2.0);
  const VisibleSurface surface = visible_surface(Scene(room(size)), {1.5, 1.0, 1.0}, all_of(size));
  EXPECT_NEAR(surface.area_m2(), 32.0, 0.01);  // 2 (6 + 6 + 4) m2
  EXPECT_EQ(static_cast<std::int64_t>(surface.points_m.size()), surface.samples);
}

TEST(VisibleSurface, LeavesOutWhatABoxStandsOnAndTheBoxesUnderside) {
  const Eigen::Vector3d size(4.0, 4.0, 3.0);
  TriangleMesh mesh = room(size);
  add_box(mesh, {1.5, 1.5, 0.0}, {2.5, 2.5, 1.0});
  const VisibleSurface surface = visible_surface(Scene(mesh), {0.7, 0.7, 1.2}, all_of(size));
  EXPECT_NEAR(static_cast<double>(surface.samples) / surface.samples_per_m2, 86.0, 0.01);
  // 80 m2 of room less the square metre under the box, and 5 m2 of box.
  EXPECT_NEAR(surface.area_m2(), 80.0 - 1.0 + 5.0, 0.1);
}

TEST(VisibleSurface, LeavesOutARoomNextDoor) {
  TriangleMesh mesh = room({3.0, 3.0, 3.0});
  add_box(mesh, {3.2, 0.0, 0.0}, {6.2, 3.0, 3.0});
  const VisibleSurface surface =
      visible_surface(Scene(mesh), {1.5, 1.5, 1.5}, all_of({6.2, 3.0, 3.0}));
  EXPECT_NEAR(surface.area_m2(), 54.0, 0.1);
}

TEST(VisibleSurface, IsTheSameToTheSampleFromEveryStart) {
  const SceneDescription description =
      find_scene("columns", std::string(NEXTVIEW_SOURCE_DIR) + "/scenes");
  const Scene scene(load_mesh(description.file, description.options));
  VisibilityParameters parameters = all_of(scene.mesh().bounds_m().max());
  parameters.reach.box_min_m = scene.mesh().bounds_m().min();
  parameters.samples_per_m2 = 40.0;
  const VisibleSurface first = visible_surface(scene, *description.start_m, parameters);
  EXPECT_GT(first.points_m.size(), 4000u);
  for (const Eigen::Vector3d& start_m :
       {Eigen::Vector3d(0.8, 3.0, 1.2), Eigen::Vector3d(0.913, 3.277, 1.111),
        Eigen::Vector3d(5.3, 0.8, 1.9), Eigen::Vector3d(0.61, 0.61, 0.61)}) {
    const VisibleSurface surface = visible_surface(scene, start_m, parameters);
    EXPECT_EQ(surface.positions, first.positions) << start_m.transpose();
    EXPECT_EQ(surface.points_m, first.points_m) << start_m.transpose();
  }
}

TEST(VisibleSurface, IsUnknownWhereNothingCanBeReached) {
  const Eigen::Vector3d size(1.0, 1.0, 0.7);  // nowhere 0.4 m from floor and ceiling
  EXPECT_THROW(visible_surface(Scene(room(size)), {0.5, 0.5, 0.35}, all_of(size)), CoverageUnknown);
}

TEST(VisibleSurface, TakesFewerSamplesOfASurfaceThatIsTooLargeAndSaysHowMany) {
  const Eigen::Vector3d size(3.0, 2.0, 2.0);
  VisibilityParameters parameters = all_of(size);
  parameters.most_samples = 3200;
  const VisibleSurface surface = visible_surface(Scene(room(size)), {1.5, 1.0, 1.0}, parameters);
  EXPECT_NEAR(surface.samples_per_m2, 100.0, 1e-4);
  EXPECT_NEAR(static_cast<double>(surface.samples), 3200.0, 1.0);
  EXPECT_NEAR(surface.area_m2(), 32.0, 0.02);
}

/// A hall full of boxes, for which there is something to do.
Scene hall() {
  TriangleMesh mesh = room({30.0, 30.0, 3.0});
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d corner(1.5 + 2.8 * (i % 10), 1.5 + 2.8 * (i / 10), 0.0);
    add_box(mesh, corner, corner + Eigen::Vector3d(1.0, 1.0, 2.9));
  }
  return Scene(mesh);
}

/// Of all threads of this process: what others do on the machine does not count.
double processor_time_s() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

TEST(VisibleSurface, LooksAtNothingOnceItIsToStop) {
  const Scene scene = hall();
  std::stop_source source;
  source.request_stop();
  WorkProgress progress;
  visible_surface(scene, {0.7, 0.7, 1.2}, all_of({30.0, 30.0, 3.0}), source.get_token(), &progress);
  EXPECT_EQ(progress.of, 0);
  EXPECT_TRUE(sample_surface(scene.mesh(), 400.0, source.get_token()).empty());
  const std::vector<Eigen::Vector3d> positions(1000, Eigen::Vector3d::Zero());
  EXPECT_EQ(PositionTree(positions, source.get_token()).root(), 0) << "a tree of one node";
}

TEST(VisibleSurface, EndsSoonWhenItIsToStop) {
  const Scene scene = hall();
  const VisibilityParameters parameters = all_of({30.0, 30.0, 3.0});
  for (const int wait_ms : {0, 20, 300}) {
    std::stop_source source;
    double asked_s = 0.0;
    std::jthread stopper([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(wait_ms));
      asked_s = processor_time_s();
      source.request_stop();
    });
    visible_surface(scene, {0.7, 0.7, 1.2}, parameters, source.get_token());
    stopper.join();
    EXPECT_LT(processor_time_s() - asked_s, 2.0) << wait_ms;
  }
}

class KeptVisibleSurface : public testing::Test {
 protected:
  KeptVisibleSurface()
      : folder_(fs::path(testing::TempDir()) /
                (std::string("nextview-") +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::remove_all(folder_);
    mesh_ = room({4.0, 4.0, 3.0});
    add_box(mesh_, {1.5, 1.5, 0.0}, {2.5, 2.5, 1.0});
  }
  ~KeptVisibleSurface() override { fs::remove_all(folder_); }

  /// @return also whether anything was looked at
  std::pair<VisibleSurface, bool> ask(const VisibilityParameters& parameters,
                                      const std::string& digest = "digest",
                                      const Eigen::Vector3d& start_m = {0.7, 0.7, 1.2}) {
    WorkProgress progress;
    VisibleSurface surface = kept_visible_surface(folder_.string(), Scene(mesh_), digest, start_m,
                                                  parameters, {}, &progress);
    return {surface, std::string_view(progress.stage) == "surface that can be seen"};
  }
  std::vector<fs::path> files() const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder_)) found.push_back(entry.path());
    return found;
  }

  fs::path folder_;
  TriangleMesh mesh_;
  VisibilityParameters parameters_ = all_of({4.0, 4.0, 3.0});
};

TEST_F(KeptVisibleSurface, IsWorkedOutOnce) {
  const auto [first, first_worked] = ask(parameters_);
  const auto [second, second_worked] = ask(parameters_, "digest", {3.3, 3.1, 1.7});
  EXPECT_TRUE(first_worked);
  EXPECT_FALSE(second_worked) << "another start in the same free space";
  EXPECT_EQ(second.points_m, first.points_m);
  EXPECT_EQ(second.samples, first.samples);
  EXPECT_EQ(second.positions, first.positions);
  EXPECT_EQ(second.area_m2(), first.area_m2());
  EXPECT_EQ(files().size(), 1u);
}

TEST_F(KeptVisibleSurface, BelongsToItsSceneAndParameters) {
  ask(parameters_);
  EXPECT_TRUE(ask(parameters_, "another").second);
  VisibilityParameters other = parameters_;
  other.range_max_m = 2.0;
  EXPECT_TRUE(ask(other).second);
  other = parameters_;
  other.reach.clearance_m = 0.3;
  EXPECT_TRUE(ask(other).second);
  EXPECT_EQ(files().size(), 4u);
}

TEST_F(KeptVisibleSurface, IsWorkedOutAgainWhenDamaged) {
  const VisibleSurface first = ask(parameters_).first;
  const fs::path file = files().at(0);
  const auto size = fs::file_size(file);
  const auto damage = [&](const char* how) {
    if (std::string_view(how) == "short") fs::resize_file(file, size - 1);
    if (std::string_view(how) == "empty") fs::resize_file(file, 0);
    if (std::string_view(how) == "flipped") {
      std::fstream bits(file, std::ios::in | std::ios::out | std::ios::binary);
      bits.seekg(static_cast<std::streamoff>(size / 2));
      const char byte = static_cast<char>(bits.peek() ^ 1);
      bits.seekp(static_cast<std::streamoff>(size / 2));
      bits.put(byte);
    }
  };
  for (const char* how : {"short", "empty", "flipped"}) {
    damage(how);
    const auto [again, worked] = ask(parameters_);
    EXPECT_TRUE(worked) << how;
    EXPECT_EQ(again.points_m, first.points_m) << how;
    EXPECT_EQ(fs::file_size(file), size) << how;
    EXPECT_FALSE(ask(parameters_).second) << how;
  }
  EXPECT_EQ(files().size(), 1u);
}

TEST_F(KeptVisibleSurface, DoesWithoutAFolderThatCannotBe) {
  std::ofstream(folder_) << "a file, where the folder should be";
  EXPECT_TRUE(ask(parameters_).second);
  EXPECT_TRUE(ask(parameters_).second);
}

TEST_F(KeptVisibleSurface, KeepsNothingThatWasStopped) {
  std::stop_source source;
  source.request_stop();
  kept_visible_surface(folder_.string(), Scene(mesh_), "digest", {0.7, 0.7, 1.2}, parameters_,
                       source.get_token());
  EXPECT_FALSE(fs::exists(folder_));
}

}  // namespace
}  // namespace nextview
