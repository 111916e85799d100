#include "planner/prediction/known_space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace nextview {
namespace {

VoxelMap empty_map() {
  VoxelMap map({0.1, Eigen::Vector3d::Zero()}, {VoxelIndex(-3, 2, 0), VoxelIndex(20, 15, 10)});
  std::fill(map.labels().begin(), map.labels().end(), Label::Empty);
  return map;
}

TEST(KnownSpace, FollowsAMapAsIfReadAnew) {
  std::mt19937 random(3);
  VoxelMap map = empty_map();
  KnownSpace followed(map, KnownSpace::Surfaces::Keep);
  int compared = 0;
  for (int round = 0; round < 50; ++round) {
    std::vector<std::uint32_t> changed;
    std::vector<std::uint32_t> updated;
    for (int i = 0; i < 30; ++i) {
      const VoxelIndex voxel = map.window().min + VoxelIndex(static_cast<int>(random() % 20),
                                                             static_cast<int>(random() % 15),
                                                             static_cast<int>(random() % 10));
      const auto label = static_cast<Label>(random() % kLabelCount);
      const auto slot = static_cast<std::uint32_t>(map.slot(voxel));
      if (map.label(voxel) == Label::Occupied) {  // stays so
        map.surface_at(voxel).normal_sum = {static_cast<int>(random() % 100), -50, 7};
        updated.push_back(slot);
      } else if (map.label(voxel) != label) {
        map.set_label(voxel, label);
        changed.push_back(slot);
      }
    }
    followed.update(changed, updated);
    const KnownSpace fresh(map, KnownSpace::Surfaces::Keep);
    for (std::size_t slot = 0; slot < map.labels().size(); ++slot) {
      const VoxelIndex voxel = map.index_of_slot(slot);
      if (!map.contains(voxel)) continue;
      ASSERT_EQ(followed.field().at(voxel), fresh.field().at(voxel)) << voxel.transpose();
      if (map.label(voxel) != Label::Occupied) continue;
      const auto surface = [&](const KnownSpace& space) {
        return space.surfaces()[space.surfaces().number_at(space.field().offset(voxel))];
      };
      EXPECT_EQ(surface(followed).normal, surface(fresh).normal);
      EXPECT_EQ(surface(followed).quality, surface(fresh).quality);
      ++compared;
    }
  }
  EXPECT_GT(compared, 1000);
}

TEST(KnownSpace, HasNoSurfacesUnlessAskedTo) {
  const VoxelMap map = empty_map();
  EXPECT_THROW(KnownSpace(map).surfaces(), std::logic_error);
  EXPECT_NO_THROW(KnownSpace(map, KnownSpace::Surfaces::Keep).surfaces());
}

}  // namespace
}  // namespace nextview
