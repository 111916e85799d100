#include "scoring/surface_coverage.h"

#include <gtest/gtest.h>

namespace nextview {
namespace {

/// Three voxels of 10 cm in a row, with 1, 3 and no samples, and 4 samples outside the window.
class ThreeVoxels : public testing::Test {
 protected:
  ThreeVoxels() : map_(VoxelGrid{}, MapWindow{{0, 0, 0}, {3, 1, 1}}) {
    surface_.points_m = {{0.00F, 0, 0}, {0.10F, 0, 0}, {0.12F, 0, 0}, {0.08F, 0.01F, 0},
                         {9, 0, 0},     {9, 1, 0},     {9, 2, 0},     {-9, 0, 0}};
  }

  FoldReport becomes_occupied(std::vector<VoxelIndex> voxels) {
    FoldReport report;
    for (const VoxelIndex& voxel : voxels) {
      map_.set_label(voxel, Label::Occupied);
      report.changed_slots.push_back(static_cast<std::uint32_t>(map_.slot(voxel)));
    }
    return report;
  }

  VoxelMap map_;
  VisibleSurface surface_;
};

TEST_F(ThreeVoxels, CountsTheSamplesInOccupiedVoxels) {
  SurfaceCoverage coverage;
  coverage.set_visible(map_, surface_);
  coverage.add_view(map_, becomes_occupied({{0, 0, 0}}));
  coverage.add_view(map_, becomes_occupied({{2, 0, 0}}));
  coverage.add_view(map_, becomes_occupied({{1, 0, 0}}));
  EXPECT_EQ(coverage.after_view(1), 1.0 / 8.0);
  EXPECT_EQ(coverage.after_view(2), 1.0 / 8.0);
  EXPECT_EQ(coverage.after_view(3), 4.0 / 8.0) << "what lies outside the map stays in the count";
}

TEST_F(ThreeVoxels, LeavesOutVoxelsThatChangedToSomethingElse) {
  SurfaceCoverage coverage;
  coverage.set_visible(map_, surface_);
  FoldReport report = becomes_occupied({{0, 0, 0}});
  map_.set_label({1, 0, 0}, Label::Empty);
  report.changed_slots.push_back(static_cast<std::uint32_t>(map_.slot({1, 0, 0})));
  coverage.add_view(map_, report);
  EXPECT_EQ(coverage.after_view(1), 1.0 / 8.0);
}

TEST_F(ThreeVoxels, IsTheSameWhenItBecomesKnownLater) {
  SurfaceCoverage coverage;
  coverage.add_view(map_, becomes_occupied({{0, 0, 0}}));
  coverage.add_view(map_, becomes_occupied({{1, 0, 0}}));
  EXPECT_EQ(coverage.after_view(1), std::nullopt);
  coverage.set_visible(map_, surface_);
  EXPECT_EQ(coverage.after_view(1), 1.0 / 8.0);
  EXPECT_EQ(coverage.after_view(2), 4.0 / 8.0);
  coverage.add_view(map_, FoldReport{});
  EXPECT_EQ(coverage.after_view(3), 4.0 / 8.0);
  EXPECT_EQ(coverage.after_view(4), std::nullopt);
}

TEST_F(ThreeVoxels, IsNothingWhenNothingCanBeSeen) {
  SurfaceCoverage coverage;
  coverage.set_visible(map_, VisibleSurface{});
  coverage.add_view(map_, becomes_occupied({{0, 0, 0}}));
  EXPECT_EQ(coverage.after_view(1), std::nullopt);
}

}  // namespace
}  // namespace nextview
