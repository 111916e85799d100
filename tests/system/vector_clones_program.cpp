// Prints mixes of the bits that come out of every function with NEXTVIEW_VECTOR_CLONES: those of a
// scan, of a map's update, of the free-space field. Compiled once for each instruction set.
#include <bit>
#include <cstdint>
#include <iostream>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "mapper/map_blocks.h"
#include "mapper/map_builder.h"
#include "planner/prediction/free_space_field.h"
#include "scene/scene.h"
#include "sensor/range_image_check.h"
#include "sensor_sim/measured_range.h"
#include "sensor_sim/scan.h"
#include "tests/scene/test_worlds.h"

namespace nextview {
namespace {

class Mix {
 public:
  void add(std::uint64_t number) { bits_ = (bits_ ^ number) * 0x9e3779b97f4a7c15U + (bits_ >> 29); }
  void add(float number) { add(std::uint64_t{std::bit_cast<std::uint32_t>(number)}); }
  std::uint64_t bits() const { return bits_; }

 private:
  std::uint64_t bits_ = 1;
};

void print(const char* what, const Mix& mix) { std::cout << what << ' ' << mix.bits() << '\n'; }

void mix_images_maps_and_fields() {
  Mix ranges;
  Mix maps;
  Mix fields;
  for (int n = 0; n < 60; ++n) {
    RandomStream random = random_stream(n);
    const Scene scene(triangle_soup(random, 120));
    const int columns = 3 + static_cast<int>(random.below(70));
    const int rows = 2 + static_cast<int>(random.below(40));
    const RayTable rays =
        make_ray_table(TiltedLineScan::with_aperture(columns, rows, 0.3 + random.uniform()));
    const VoxelGrid grid{0.06 + 0.1 * random.uniform(), random_point(random, 1.0)};
    const VoxelIndex size(40 + static_cast<int>(random.below(30)), 61, 37);
    MapBuilder builder(grid, {grid.voxel_of(Eigen::Vector3d::Zero()) - size / 2, size});
    FreeSpaceField field(builder.map());
    for (int view = 0; view < 4; ++view) {
      const SensorPose pose = {random_point(random, 0.8), 2.0 * std::numbers::pi * random.uniform(),
                               std::numbers::pi * (random.uniform() - 0.5)};
      const double noise_m = view % 2 == 0 ? 0.0 : 0.01;
      const RangeImage image = scan(scene, rays, {0.1, 3.0}, pose, noise_m, random);
      for (const float range_m : image.range_m) ranges.add(range_m);
      field.update(builder.map(), builder.fold(image).changed_slots);
      for (const char digit : builder.digest()) maps.add(static_cast<std::uint64_t>(digit));
      maps.add(static_cast<std::uint64_t>(builder.statistics().occlusion_plane_faces));
      maps.add(std::bit_cast<std::uint64_t>(builder.statistics().mean_quality));
    }
    for_each_voxel(builder.map().window(),
                   [&](const VoxelIndex& voxel) { fields.add(std::uint64_t{field.at(voxel)}); });
  }
  print("ranges", ranges);
  print("maps", maps);
  print("fields", fields);
}

void mix_measured_ranges() {
  Mix mix;
  RandomStream random = random_stream(1);
  for (std::size_t count = 0; count < 300; ++count) {
    std::vector<float> distances_m(count);
    for (float& distance_m : distances_m) {
      distance_m = random.below(9) == 0 ? std::numeric_limits<float>::infinity()
                                        : static_cast<float>(6.0 * random.uniform());
    }
    measure_ranges({0.2, 5.0}, distances_m);
    for (const float range_m : distances_m) mix.add(range_m);
  }
  print("measured_ranges", mix);
}

// Ranges that are right, and with one that is negative in every place of the vectors and of what is
// left over behind them.
void mix_range_checks() {
  Mix mix;
  RandomStream random = random_stream(2);
  for (std::size_t count = 0; count < 70; ++count) {
    std::vector<float> range_m(count);
    for (float& each : range_m) {
      each = random.below(5) == 0 ? std::numeric_limits<float>::quiet_NaN()
                                  : static_cast<float>(6.0 * random.uniform());
    }
    mix.add(std::uint64_t{are_ranges(range_m)});
    for (float& each : range_m) {
      for (const float wrong : {-0.5f, -std::numeric_limits<float>::infinity(), -0.0f}) {
        const float right = std::exchange(each, wrong);
        mix.add(std::uint64_t{are_ranges(range_m)});
        each = right;
      }
    }
  }
  print("range_checks", mix);
}

void mix_block_numbers() {
  Mix mix;
  const VoxelMap map({}, {{-13, 5, 1000}, {50, 64, 9}});
  const MapBlocks blocks(map);
  std::vector<std::uint32_t> slots;
  for_each_voxel(map.window(), [&](const VoxelIndex& voxel) {
    slots.push_back(static_cast<std::uint32_t>(map.slot(voxel)));
  });
  std::vector<std::uint32_t> numbers(slots.size());
  blocks.blocks_of(slots, numbers.data());
  for (const std::uint32_t number : numbers) mix.add(std::uint64_t{number});
  print("block_numbers", mix);
}

}  // namespace
}  // namespace nextview

int main() {
  nextview::mix_images_maps_and_fields();
  nextview::mix_measured_ranges();
  nextview::mix_range_checks();
  nextview::mix_block_numbers();
}
