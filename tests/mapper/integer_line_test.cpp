// The edge cases of a voxel walk, by name, and its closed form against a count.
#include "mapper/integer_line.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/mapper/analytic_world.h"

namespace nextview {
namespace {

std::vector<VoxelIndex> voxels(const IntegerLine& line, int last) {
  std::vector<VoxelIndex> indices;
  for (int k = 0; k <= last; ++k) indices.push_back(line.at(k));
  return indices;
}

TEST(IntegerLine, ZeroStepsStaysWhereItIs) {
  const IntegerLine line = line_between({3, -4, 5}, {3, -4, 5});
  EXPECT_EQ(line.steps, 0);
  EXPECT_EQ(line.at(0), VoxelIndex(3, -4, 5));
  EXPECT_EQ(line.at(7), VoxelIndex(3, -4, 5));
  EXPECT_EQ(steps_inside(line, {{0, -5, 0}, {8, 8, 8}}), 0);
}

TEST(IntegerLine, AxisParallelBothWays) {
  EXPECT_EQ(voxels(line_between({0, 0, 0}, {0, 0, -2}), 3),
            (std::vector<VoxelIndex>{{0, 0, 0}, {0, 0, -1}, {0, 0, -2}, {0, 0, -3}}));
  EXPECT_EQ(voxels(line_between({-1, 2, 0}, {1, 2, 0}), 3),
            (std::vector<VoxelIndex>{{-1, 2, 0}, {0, 2, 0}, {1, 2, 0}, {2, 2, 0}}));
}

TEST(IntegerLine, ZeroComponentNeverMoves) {
  const IntegerLine line = line_between({0, 0, 9}, {5, -3, 9});
  for (int k = 0; k < 100; ++k) EXPECT_EQ(line.at(k)[2], 9);
}

TEST(IntegerLine, DiagonalTiesGoToTheLowerAxis) {
  const IntegerLine line = line_between({0, 0, 0}, {-3, 3, -3});
  EXPECT_EQ(line.driving_axis, 0);
  EXPECT_EQ(line.direction, -1);
  for (int k = 0; k < 10; ++k) EXPECT_EQ(line.at(k), VoxelIndex(-k, k, -k));
}

TEST(IntegerLine, ExactBoundaryIsRoundedUp) {
  // After one step of two the other axis has advanced by exactly half a voxel: (k a + 1/2) >> 0.
  EXPECT_EQ(line_between({0, 0, 0}, {2, 1, 0}).at(1), VoxelIndex(1, 1, 0));
  EXPECT_EQ(line_between({0, 0, 0}, {2, -1, 0}).at(1), VoxelIndex(1, 0, 0));
}

TEST(IntegerLine, NegativeIndicesShiftArithmetically) {
  const IntegerLine line = line_between({-10, -10, -10}, {-16, -12, -11});
  EXPECT_EQ(voxels(line, 6), (std::vector<VoxelIndex>{{-10, -10, -10},
                                                      {-11, -10, -10},
                                                      {-12, -11, -10},
                                                      {-13, -11, -11},
                                                      {-14, -11, -11},
                                                      {-15, -12, -11},
                                                      {-16, -12, -11}}));
}

TEST(IntegerLine, EndsWhereItShouldForRandomEnds) {
  RandomStream random(1, 1, 1, RandomPurpose::RangeNoise);
  for (int n = 0; n < 100'000; ++n) {
    const int reach = n % 2 == 0 ? 20 : 16000;
    const auto index = [&] {
      return VoxelIndex(uniform_int(random, -reach, reach), uniform_int(random, -reach, reach),
                        uniform_int(random, -reach, reach));
    };
    const VoxelIndex start = index();
    const VoxelIndex end = index();
    const IntegerLine line = line_between(start, end);
    ASSERT_EQ(line.at(0), start);
    ASSERT_EQ(line.at(line.steps), end);
  }
}

TEST(IntegerLine, TooLongIsRefused) {
  EXPECT_NO_THROW(line_between({0, 0, 0}, {0, 32767, 0}));
  EXPECT_THROW(line_between({0, 0, 0}, {0, -32768, 0}), std::invalid_argument);
}

TEST(IntegerLine, StepsInsideIsExactForRandomLinesAndWindows) {
  RandomStream random(2, 1, 1, RandomPurpose::RangeNoise);
  int lines = 0;
  while (lines < 100'000) {
    MapWindow window;
    VoxelIndex start;
    VoxelIndex end;
    for (int axis = 0; axis < 3; ++axis) {
      window.min[axis] = uniform_int(random, -50, 50);
      window.size[axis] = uniform_int(random, 1, 60);
      start[axis] = window.min[axis] + uniform_int(random, 0, window.size[axis] - 1);
      end[axis] = start[axis] + (random.below(4) == 0 ? 0 : uniform_int(random, -90, 90));
    }
    const IntegerLine line = line_between(start, end);
    if (line.steps == 0) continue;
    const int inside = steps_inside(line, window);
    ASSERT_GE(inside, 0);
    for (int k = 0; k <= inside; ++k) ASSERT_TRUE(window.contains(line.at(k)));
    ASSERT_FALSE(window.contains(line.at(inside + 1)));
    ++lines;
  }
}

TEST(IntegerLine, LineAlongADirectionDoesNotDependOnItsStart) {
  const Eigen::Vector3d direction = Eigen::Vector3d(3.0, -2.0, 6.0) / 7.0;
  const IntegerLine a = line_along({0, 0, 0}, direction, 70.0);
  const IntegerLine b = line_along({-100, 5, 77}, direction, 70.0);
  EXPECT_EQ(a.at(a.steps), VoxelIndex(30, -20, 60));
  for (int k = 0; k < 200; ++k) EXPECT_EQ(a.at(k) + VoxelIndex(-100, 5, 77), b.at(k));
  EXPECT_THROW(line_along({0, 0, 0}, direction, 0.5), std::invalid_argument);
}

}  // namespace
}  // namespace nextview
