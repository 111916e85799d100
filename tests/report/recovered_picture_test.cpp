#include "report/recovered_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <stdexcept>

namespace nextview {
namespace {

// 9 x 9 x 9 voxels of 0.1 m, all Unmarked.
VoxelMap small_map() {
  return VoxelMap({0.1, Eigen::Vector3d::Zero()}, {VoxelIndex::Zero(), VoxelIndex(9, 9, 9)});
}

int coloured_pixels(const Picture& picture) {
  int coloured = 0;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
    coloured += std::any_of(&picture.rgb[i], &picture.rgb[i] + 3,
                            [](std::uint8_t value) { return value != 255; });
  }
  return coloured;
}

// A plate of Occupied voxels at z = 0.4 m, with Empty above (side = 1) or below (side = -1) it.
VoxelMap plate(int side) {
  VoxelMap map = small_map();
  for (int j = 0; j < 9; ++j) {
    for (int i = 0; i < 9; ++i) {
      map.set_label({i, j, 4}, Label::Occupied);
      map.set_label({i, j, 4 + side}, Label::Empty);
    }
  }
  return map;
}

const PictureView kFromAbove{100, 100, 245.0, 89.0};

TEST(RecoveredPicture, ShowsAFaceFromItsEmptySideOnly) {
  const Picture floor = recovered_picture(plate(1), {}, kFromAbove);
  EXPECT_EQ(floor.rgb.size(), 3U * 100U * 100U);
  EXPECT_GT(coloured_pixels(floor), 2000);
  // A ceiling of which one voxel is seen from above too, as there has to be something to draw.
  VoxelMap ceiling = plate(-1);
  ceiling.set_label({4, 4, 5}, Label::Empty);
  const Picture from_above = recovered_picture(ceiling, {}, kFromAbove);
  EXPECT_GT(coloured_pixels(from_above), 10);
  EXPECT_LT(coloured_pixels(from_above), 300);
}

TEST(RecoveredPicture, DrawsThePath) {
  const std::array<SensorPose, 2> poses = {SensorPose{{0.1, 0.1, 0.7}, 0.0, 0.0},
                                           SensorPose{{0.7, 0.7, 0.7}, 0.0, 0.0}};
  EXPECT_NE(recovered_picture(plate(1), poses, kFromAbove).rgb,
            recovered_picture(plate(1), {}, kFromAbove).rgb);
}

TEST(RecoveredPicture, WithNothingOccupiedThereIsNothingToDraw) {
  EXPECT_THROW(recovered_picture(small_map(), {}, kFromAbove), std::invalid_argument);
}

TEST(RecoveredPicture, IsWrittenAsPng) {
  const std::string file = ::testing::TempDir() + "nextview_picture_test.png";
  write_png({2, 1, {255, 0, 0, 0, 0, 255}}, file);
  std::ifstream in(file, std::ios::binary);
  std::array<char, 4> head{};
  in.read(head.data(), 4);
  EXPECT_EQ(std::string(&head[1], 3), "PNG");
  EXPECT_THROW(write_png({2, 1, {255, 0, 0, 0, 0, 255}}, "/no/such/folder/x.png"),
               std::runtime_error);
}

}  // namespace
}  // namespace nextview
