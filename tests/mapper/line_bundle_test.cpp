// Lines walked side by side against the same lines walked one by one, on every instruction set.
#include "mapper/line_bundle.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <iostream>
#include <set>

#include "tests/mapper/analytic_world.h"

namespace nextview {
namespace {

struct Stretch {
  IntegerLine line;
  int first;
  int last;
};

// The slots of labels below one in the order they are first met: step by step, and line by line
// within a step.
std::vector<std::uint32_t> first_meetings(const VoxelMap& map, const std::vector<Stretch>& all,
                                          Label below) {
  std::vector<std::uint32_t> slots;
  std::set<std::uint32_t> met;
  for (int step = 0; step < 100'000; ++step) {
    bool any = false;
    for (const Stretch& stretch : all) {
      if (stretch.first + step > stretch.last) continue;
      any = true;
      const auto slot = static_cast<std::uint32_t>(map.slot(stretch.line.at(stretch.first + step)));
      if (met.insert(slot).second && map.labels()[slot] < below) slots.push_back(slot);
    }
    if (!any) break;
  }
  return slots;
}

std::vector<std::uint32_t> without_repeats(const LineBundle::Slots& slots) {
  std::vector<std::uint32_t> kept;
  std::set<std::uint32_t> met;
  for (std::size_t n = 0; n < slots.size; ++n) {
    if (met.insert(slots.begin[n]).second) kept.push_back(slots.begin[n]);
  }
  return kept;
}

VoxelMap random_map(RandomStream& random) {
  constexpr std::array<int, 8> kSizes = {1, 2, 7, 8, 9, 33, 64, 300};
  MapWindow window;
  for (int axis = 0; axis < 3; ++axis) {
    window.size[axis] = kSizes[random.below(8)];
    window.min[axis] = uniform_int(random, -400'000, 400'000);
  }
  VoxelMap map(VoxelGrid(), window);
  for (Label& label : map.labels()) label = static_cast<Label>(random.below(kLabelCount));
  return map;
}

VoxelIndex random_voxel(const MapWindow& window, RandomStream& random) {
  VoxelIndex voxel = window.min;
  for (int axis = 0; axis < 3; ++axis) voxel[axis] += uniform_int(random, 0, window.size[axis] - 1);
  return voxel;
}

// Up to a bundleful of lines from one sensor, most of them close to one another.
std::vector<Stretch> random_stretches(const VoxelMap& map, RandomStream& random) {
  const MapWindow& window = map.window();
  const VoxelIndex sensor = random_voxel(window, random);
  VoxelIndex end = random_voxel(window, random);
  std::vector<Stretch> stretches;
  for (int n = uniform_int(random, 1, LineBundle::kLines); n > 0; --n) {
    for (int axis = 0; axis < 3; ++axis) end[axis] += uniform_int(random, -1, 1);
    if (random.below(8) == 0) end = random_voxel(window, random);
    const IntegerLine line = line_between(sensor, end);
    const int inside = steps_inside(line, window);
    const int first = random.below(2) == 0 ? 0 : uniform_int(random, 0, inside);
    stretches.push_back({line, first, uniform_int(random, first - 1, inside)});
  }
  return stretches;
}

TEST(LineBundle, MeetsTheVoxelsOfItsLinesInOneOrderOnEveryInstructionSet) {
  std::int64_t voxels = 0;
  int bundles = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    for (int n = 0; n < 300; ++n) {
      SCOPED_TRACE(std::string(hwy::TargetName(target)) + ", case " + std::to_string(n));
      RandomStream random(n, 1, 1, RandomPurpose::RangeNoise);
      const VoxelMap map = random_map(random);
      LineBundle bundle(map);
      for (int use = 0; use < 4; ++use) {  // one object serves many bundles
        const std::vector<Stretch> stretches = random_stretches(map, random);
        for (const Stretch& s : stretches) bundle.add(s.line, s.first, s.last);
        EXPECT_EQ(bundle.full(), stretches.size() == LineBundle::kLines);
        const auto below = static_cast<Label>(random.below(kLabelCount + 1));
        const auto expected = first_meetings(map, stretches, below);
        ASSERT_EQ(without_repeats(bundle.take_slots(map, below)), expected);
        voxels += static_cast<std::int64_t>(expected.size());
        ++bundles;
      }
    }
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  EXPECT_GT(voxels, 50'000);
  std::cout << bundles << " bundles, " << voxels << " voxels\n";
}

TEST(LineBundle, IsEmptyOnceItsSlotsAreTaken) {
  const VoxelMap map(VoxelGrid(), {VoxelIndex::Zero(), {64, 64, 64}});
  LineBundle bundle(map);
  bundle.add(line_between({1, 2, 3}, {31, 12, 23}), 0, 30);
  bundle.add(line_between({1, 2, 3}, {31, 12, 23}), 5, 4);  // no voxel at all
  EXPECT_EQ(bundle.take_slots(map, Label::Occluded).size, 31u);
  EXPECT_EQ(bundle.take_slots(map, Label::Occluded).size, 0u);
}

}  // namespace
}  // namespace nextview
