// The map for others: what a program that follows it puts together from NEXTVIEW_MAP_BLOCKS is the
// mapper's map, whether it asks for all of it or for what has changed, and whatever the bus loses.

#include <gtest/gtest.h>

#include <algorithm>

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "mapper/map_blocks_message.h"
#include "mapper/mapper_config.h"
#include "mapper/mapper_process.h"
#include "sensor/sensor_config.h"
#include "sensor_sim/scan.h"
#include "tests/lcmtypes/lossy_network.h"
#include "tests/mapper/small_world.h"
#include "tests/planner/boxes_run.h"

namespace nextview {
namespace {

using std::chrono::milliseconds;

/// A map put together from messages alone, as docs/map-blocks.md says.
class Follower {
 public:
  struct Block {
    int view = 0;  // as of which it is
    std::vector<std::uint8_t> labels;
    std::vector<std::vector<float>> normals;  // of its Occupied voxels
    std::vector<float> qualities;
    bool operator==(const Block& other) const {  // whenever it has come
      return labels == other.labels && normals == other.normals && qualities == other.qualities;
    }
  };
  using Blocks = std::map<std::vector<std::int32_t>, Block>;

  void take(const map_blocks_t& part) {
    std::size_t surface = 0;
    for (std::size_t b = 0; b < part.block_index.size(); ++b) {
      Block block;
      block.view = part.view;
      block.labels = part.block_label[b];
      for (const std::uint8_t label : block.labels) {
        if (label != static_cast<std::uint8_t>(Label::Occupied)) continue;
        block.normals.push_back(part.surface_normal[surface]);
        block.qualities.push_back(part.surface_quality[surface]);
        ++surface;
      }
      Block& known = blocks_[part.block_index[b]];
      if (known.view <= block.view) known = std::move(block);
    }
    EXPECT_EQ(surface, part.surface_quality.size());
    auto& came = came_[{part.since_view, part.view}];
    came.insert(part.part);
    if (std::ssize(came) == part.parts && part.since_view <= view_ && part.view > view_) {
      view_ = part.view;
    }
  }

  /// The map is whole as of this view.
  int view() const { return view_; }
  const Blocks& blocks() const { return blocks_; }

  std::int64_t voxels(Label label) const {
    std::int64_t count = 0;
    for (const auto& [index, block] : blocks_) {
      count +=
          std::count(block.labels.begin(), block.labels.end(), static_cast<std::uint8_t>(label));
    }
    return count;
  }
  double mean_quality() const {
    double sum = 0.0;
    for (const auto& [index, block] : blocks_) {
      for (const float quality : block.qualities) sum += quality;
    }
    return sum / static_cast<double>(voxels(Label::Occupied));
  }

 private:
  Blocks blocks_;
  int view_ = 0;
  std::map<std::pair<int, int>, std::set<int>> came_;
};

struct Case {
  LossyNetwork::Faults faults;
  std::optional<VoxelIndex> window;  // what of the mapper's map lies open; all of it
};

class MapForOthers : public testing::TestWithParam<Case> {
 protected:
  MapForOthers() {
    mapper_bus_.on_missing([this](const request_t& request) { mapper_.on_missing(request); });
    other_.on<commit_t>([this](const commit_t& commit) { commits_[commit.view] = commit; });
    other_.on<map_blocks_t>([this](const map_blocks_t& part) { parts_.push_back(part); });
  }

  /// A goal and the arrival there, without which no image is believed.
  void go_to(const SensorPose& pose, int view) {
    goal_t goal = example<goal_t>();
    arrival_t arrival = example<arrival_t>();
    goal.utime = arrival.utime = 1000 * view;
    goal.view = arrival.view = view;
    goal.attempt = arrival.attempt = 1;
    arrival.arrived = 1;
    arrival.refusal.clear();
    std::copy_n(pose.position_m.data(), 3, arrival.believed_position_m);
    arrival.believed_pan_rad = pose.pan_rad;
    arrival.believed_tilt_rad = pose.tilt_rad;
    sensor_bus_.publish(goal);
    sensor_bus_.publish(arrival);
  }
  /// Scans from one of a few places and has the mapper fold it.
  void fold_view(int view) {
    RandomStream no_noise(1, view, 1, RandomPurpose::RangeNoise);
    const SensorPose pose{{0.7 + 0.4 * view, 1.0, 1.2}, -1.5 + 0.9 * view, -0.1};
    const RangeImage image = scan(room_, make_ray_table(sensor_of(config_)),
                                  range_limits_of(config_), pose, 0.0, no_noise);
    twin_.fold(image);
    go_to(pose, view);
    for (range_image_t& part : range_image_messages(image, view, 1, 1000 * view)) {
      sensor_bus_.publish(std::move(part));
    }
  }
  bool turn() {
    bool worked = mapper_.step();
    for (Bus* bus : {&sensor_bus_, &mapper_bus_, &other_}) worked |= bus->handle(milliseconds(0));
    return worked;
  }
  void run() {
    while (turn()) {
    }
  }
  void wait_for_commit(int view) {
    for (int asked = 0; asked < 1000 && !commits_.contains(view); ++asked) {
      run();
      if (!commits_.contains(view)) other_.request<commit_t>(view, 0);
    }
    ASSERT_TRUE(commits_.contains(view));
  }
  /// Asks until a follower's map is whole as of a view.
  void follow(Follower& follower, int view) {
    for (int asked = 0; asked < 1000 && follower.view() < view; ++asked) {
      other_.request<map_blocks_t>(follower.view(), 0);
      run();
      for (const map_blocks_t& part : parts_) follower.take(part);
      parts_.clear();
    }
    ASSERT_EQ(follower.view(), view);
  }

  static run_config_t fine_config() {
    run_config_t config = boxes_run_config();
    config.sensor.columns = 64;
    config.sensor.rows = 30;
    return config;
  }

  run_config_t config_ = fine_config();
  Scene room_{load_mesh(config_.scene_file)};
  MapBuilder twin_{grid_of(config_), window_of(config_)};
  LossyNetwork network_{GetParam().faults, 3};
  Bus sensor_bus_{network_.connect(), 7, "sensor_sim"};
  Bus mapper_bus_{network_.connect(), 7, "mapper"};
  Bus other_{network_.connect(), 7, "other"};
  MapperProcess mapper_{mapper_bus_, config_, GetParam().window};
  std::map<int, commit_t> commits_;
  std::vector<map_blocks_t> parts_;
};

/// What a map has in a block, in the form of the messages.
Follower::Block block_of_map(const VoxelMap& map, const VoxelIndex& index) {
  Follower::Block block;
  for (int v = 0; v < kBlockVoxels; ++v) {
    const VoxelIndex voxel = kBlockSide * index + VoxelIndex(v % 8, v / 8 % 8, v / 64);
    block.labels.push_back(static_cast<std::uint8_t>(map.label(voxel)));
    if (map.label(voxel) != Label::Occupied) continue;
    const Eigen::Vector3f normal = map.surface(voxel)->mean_normal().cast<float>();
    block.normals.push_back({normal.x(), normal.y(), normal.z()});
    block.qualities.push_back(static_cast<float>(map.surface(voxel)->quality_01()));
  }
  return block;
}

TEST_P(MapForOthers, IsTheMappersInStepsAndAtOnce) {
  Follower in_steps;
  for (int view = 1; view <= 5; ++view) {
    fold_view(view);
    wait_for_commit(view);
    follow(in_steps, view);
    const commit_t& commit = commits_.at(view);
    EXPECT_EQ(in_steps.voxels(Label::Occluded), commit.occluded_voxels);
    EXPECT_EQ(in_steps.voxels(Label::OcclusionPlane), commit.occlusion_plane_voxels);
    EXPECT_EQ(in_steps.voxels(Label::Empty), commit.empty_voxels);
    EXPECT_EQ(in_steps.voxels(Label::Occupied), commit.occupied_voxels);
    EXPECT_NEAR(in_steps.mean_quality(), commit.mean_quality, 1e-6);

    Follower at_once;
    follow(at_once, view);
    EXPECT_EQ(at_once.blocks(), in_steps.blocks()) << "view " << view;
  }
  EXPECT_EQ(commits_.at(5).map_digest, twin_.digest());
  std::size_t voxels = 0;
  for (const auto& [index, block] : in_steps.blocks()) {
    EXPECT_EQ(block, block_of_map(twin_.map(), VoxelIndex(index.data())));
    voxels += block.labels.size();
  }
  EXPECT_GT(voxels, 50000U);
}

INSTANTIATE_TEST_SUITE_P(OnABus, MapForOthers,
                         testing::Values(Case{}, Case{{0.2, 0.2, 0.2}, {}},
                                         Case{{}, VoxelIndex(16, 16, 8)},
                                         Case{{0.2, 0.2, 0.2}, VoxelIndex(16, 16, 8)}));

using MapBlocksMessages = MapForOthers;

TEST_P(MapBlocksMessages, AreLargePartsWithinTheLimitAndTheSameToWhoeverAsksTwice) {
  fold_view(1);
  run();
  other_.request<map_blocks_t>(0, 0);
  other_.request<map_blocks_t>(0, 0);
  while (mapper_bus_.handle(milliseconds(0))) {
  }
  run();
  std::map<int, std::vector<std::uint8_t>> first;
  std::size_t bytes = 0;
  for (const map_blocks_t& part : parts_) {
    const auto encoded = encode(part);
    EXPECT_LE(encoded.size(), kMaxMessageBytes);
    bytes += encoded.size();
    EXPECT_TRUE(first.emplace(part.part, encoded).second) << "one answer for both";
  }
  EXPECT_EQ(std::ssize(first), parts_.front().parts);
  EXPECT_GT(first.size(), 1U);
  EXPECT_GT(bytes / first.size(), kMaxMessageBytes / 2);
  parts_.clear();
  other_.request<map_blocks_t>(0, 0);
  run();
  EXPECT_EQ(parts_.size(), first.size());
  for (const map_blocks_t& part : parts_) EXPECT_EQ(encode(part), first.at(part.part));
}

TEST_P(MapBlocksMessages, SayThatNothingHasChanged) {
  other_.request<map_blocks_t>(0, 0);
  run();
  ASSERT_EQ(parts_.size(), 1U);
  EXPECT_EQ(parts_[0].view, 0);
  EXPECT_EQ(parts_[0].blocks, 0);

  fold_view(1);
  run();
  parts_.clear();
  for (const int since : {1, 9}) other_.request<map_blocks_t>(since, 0);
  run();
  ASSERT_EQ(parts_.size(), 2U);
  for (const map_blocks_t& part : parts_) {
    EXPECT_EQ(part.since_view, 1);
    EXPECT_EQ(part.view, 1);
    EXPECT_EQ(part.blocks, 0);
    EXPECT_EQ(part.parts, 1);
  }
}

TEST_P(MapBlocksMessages, NameOnlyWhatHasChanged) {
  fold_view(1);
  fold_view(2);
  run();
  other_.request<map_blocks_t>(1, 0);
  run();
  const VoxelMap& after = twin_.map();
  MapBuilder before(grid_of(config_), window_of(config_));
  std::set<std::vector<std::int32_t>> named;
  for (const map_blocks_t& part : parts_) {
    EXPECT_EQ(part.since_view, 1);
    EXPECT_EQ(part.view, 2);
    EXPECT_EQ(part.utime, 2000);
    named.insert(part.block_index.begin(), part.block_index.end());
  }
  RandomStream no_noise(1, 1, 1, RandomPurpose::RangeNoise);
  before.fold(scan(room_, make_ray_table(sensor_of(config_)), range_limits_of(config_),
                   {{1.1, 1.0, 1.2}, -0.6, -0.1}, 0.0, no_noise));
  int unchanged = 0;
  for (int z = -1; z < 8; ++z) {
    for (int y = -1; y < 8; ++y) {
      for (int x = -1; x < 8; ++x) {
        const VoxelIndex index(x, y, z);
        const bool same = block_of_map(before.map(), index) == block_of_map(after, index);
        EXPECT_TRUE(same || named.contains({x, y, z})) << x << " " << y << " " << z;
        unchanged += same && !named.contains({x, y, z});
      }
    }
  }
  EXPECT_GT(unchanged, 100);
}

TEST_P(MapBlocksMessages, AreAsOfOneViewAndLetImagesGoFirst) {
  fold_view(1);
  run();
  other_.request<map_blocks_t>(0, 0);
  while (!mapper_bus_.handle(milliseconds(0))) {
  }
  EXPECT_TRUE(mapper_.step());  // the first part
  fold_view(2);
  while (mapper_bus_.handle(milliseconds(0))) {
  }
  const std::size_t before = network_.published().size();
  EXPECT_TRUE(mapper_.step());
  EXPECT_EQ(network_.published().at(before).first, Channel<commit_t>::name);
  run();
  EXPECT_GT(parts_.size(), 1U);
  for (const map_blocks_t& part : parts_) EXPECT_EQ(part.view, 1);
}

INSTANTIATE_TEST_SUITE_P(OnAQuietBus, MapBlocksMessages,
                         testing::Values(Case{}, Case{{}, VoxelIndex(16, 16, 8)}));

// Whoever follows need not know whether the mapper has a window.
TEST(MapBlocksOfAWindow, AreTheSameToTheLastBit) {
  int blocks = 0;
  for (int n = 0; n < 100; ++n) {
    SCOPED_TRACE("world " + std::to_string(n));
    RandomStream random(n, 4, 1, RandomPurpose::RangeNoise);
    const SmallWorld world = random_small_world(random);
    MapBuilder whole(world.grid, world.window);
    BlockHistory history(whole.map());
    PagedMapBuilder paged(world.grid, world.window, {8, 16, 8});
    for (int view = 1; view <= 5; ++view) {
      const RangeImage image = random_view(world, random_sensor(random), random);
      history.view_folded(view, whole.fold(image));
      paged.fold(image);
      for (int since = 0; since <= view; ++since) {
        const auto expected = map_blocks_messages(whole.map(), history, view, since, 1000);
        const auto answer = map_blocks_messages(paged, view, since, 1000);
        ASSERT_EQ(answer.size(), expected.size());
        for (std::size_t part = 0; part < answer.size(); ++part) {
          blocks += answer[part].blocks;
          ASSERT_EQ(encode(answer[part]), encode(expected[part])) << "since " << since;
        }
      }
    }
  }
  EXPECT_GT(blocks, 10000);
}

}  // namespace
}  // namespace nextview
