#include "planner/prediction/chebyshev_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace nextview {
namespace {

// Distances of a box by the definition, cell by cell; x runs fastest, then y.
std::vector<int> brute_force(const VoxelIndex& cells, const std::vector<VoxelIndex>& obstacles) {
  std::vector<int> distances;
  for (int z = 0; z < cells[2]; ++z) {
    for (int y = 0; y < cells[1]; ++y) {
      for (int x = 0; x < cells[0]; ++x) {
        int nearest = ChebyshevDistance::kLargest;
        for (const VoxelIndex& obstacle : obstacles) {
          nearest = std::min(nearest, (obstacle - VoxelIndex(x, y, z)).cwiseAbs().maxCoeff());
        }
        distances.push_back(nearest);
      }
    }
  }
  return distances;
}

std::vector<int> by_rows(ChebyshevDistance& distance, const VoxelIndex& cells,
                         const std::vector<VoxelIndex>& obstacles, int threads = 1) {
  distance.resize(cells, threads);
  std::vector<std::uint8_t> is_obstacle(static_cast<std::size_t>(cells.prod()), 0);
  const auto at = [&cells](int x, int y, int z) {
    return static_cast<std::size_t>((z * cells[1] + y) * cells[0] + x);
  };
  for (const VoxelIndex& obstacle : obstacles) {
    is_obstacle[at(obstacle[0], obstacle[1], obstacle[2])] = 1;
  }
  for (int z = 0; z < cells[2]; ++z) {
    for (int y = 0; y < cells[1]; ++y) distance.fill_row(y, z, &is_obstacle[at(0, y, z)], 0);
  }
#pragma omp parallel num_threads(threads) if (threads > 1)
  distance.find();
  std::vector<int> distances;
  for (int z = 0; z < cells[2]; ++z) {
    for (int y = 0; y < cells[1]; ++y) {
      distances.insert(distances.end(), distance.row(y, z), distance.row(y, z) + cells[0]);
    }
  }
  return distances;
}

TEST(ChebyshevDistance, ABoxWithoutObstaclesIsAllFarAway) {
  ChebyshevDistance distance;
  const VoxelIndex cells(40, 3, 2);
  EXPECT_EQ(by_rows(distance, cells, {}), std::vector<int>(240, ChebyshevDistance::kLargest));
}

TEST(ChebyshevDistance, GrowsByOneAMoveOfTheKing) {
  ChebyshevDistance distance;
  by_rows(distance, {80, 50, 45}, {{40, 2, 3}});
  EXPECT_EQ(distance.row(2, 3)[40], 0);
  EXPECT_EQ(distance.row(3, 4)[41], 1);
  EXPECT_EQ(distance.row(2, 3)[35], 5);
  EXPECT_EQ(distance.row(30, 3)[50], 28);
  EXPECT_EQ(distance.row(20, 33)[45], 30);
  EXPECT_EQ(distance.row(40, 44)[79], ChebyshevDistance::kLargest);
}

// Rows lie one behind the other in memory; an obstacle at the end of one is far from the beginning
// of the next.
TEST(ChebyshevDistance, DoesNotGoAroundTheEndsOfRowsAndLayers) {
  ChebyshevDistance distance;
  for (int columns = 1; columns <= 100; ++columns) {
    const VoxelIndex cells(columns, 40, 35);
    by_rows(distance, cells, {{columns - 1, 0, 0}, {0, 39, 34}});
    ASSERT_EQ(distance.row(1, 0)[0], std::min(std::max(columns - 1, 1), 31)) << columns;
    ASSERT_EQ(distance.row(0, 1)[0], std::min(std::max(columns - 1, 1), 31)) << columns;
    ASSERT_EQ(distance.row(38, 34)[columns - 1], std::min(std::max(columns - 1, 1), 31));
    ASSERT_EQ(distance.row(39, 0)[0], ChebyshevDistance::kLargest);
  }
}

TEST(ChebyshevDistance, AgreesWithTheDefinitionInRandomBoxes) {
  std::mt19937 random(5);
  const auto below = [&random](int n) {
    return static_cast<int>(random() % static_cast<unsigned>(n));
  };
  ChebyshevDistance distance;  // one for all: it must forget the last box
  int cells_compared = 0;
  for (int box = 0; box < 150; ++box) {
    // Every tenth box has one or two layers, fewer than threads.
    const VoxelIndex cells(1 + below(75), 1 + below(45), 1 + below(box % 10 == 0 ? 2 : 40));
    std::vector<VoxelIndex> obstacles;
    for (int i = below(12); i > 0; --i) {
      obstacles.emplace_back(below(cells[0]), below(cells[1]), below(cells[2]));
    }
    const std::vector<int> expected = brute_force(cells, obstacles);
    for (const int threads : {1, 2, 3, 7}) {
      ASSERT_EQ(by_rows(distance, cells, obstacles, threads), expected)
          << "box " << box << " of " << cells.transpose() << ", " << threads << " threads";
    }
    cells_compared += cells.prod();
  }
  EXPECT_GE(cells_compared, 1'000'000);
}

}  // namespace
}  // namespace nextview
