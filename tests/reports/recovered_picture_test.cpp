#include "reports/picture_file.h"

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
  EXPECT_NE(recovered_picture(plate(1), {poses, {}, {}}, kFromAbove).rgb,
            recovered_picture(plate(1), {}, kFromAbove).rgb);
}

TEST(RecoveredPicture, WithNothingOccupiedThereIsNothingToDraw) {
  EXPECT_THROW(recovered_picture(small_map(), {}, kFromAbove), std::invalid_argument);
}

// Pixels that are mostly of one colour, in the order red, green, blue.
int pixels_of(const Picture& picture, bool red, bool green, bool blue) {
  int count = 0;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
    const auto is = [&](std::size_t channel, bool strong) {
      return strong ? picture.rgb[i + channel] > 160 : picture.rgb[i + channel] < 60;
    };
    count += is(0, red) && is(1, green) && is(2, blue) ? 1 : 0;
  }
  return count;
}

// A floor with a hole of 3 x 3 voxels in it, unknown under Empty space.
VoxelMap plate_with_hole() {
  VoxelMap map = plate(1);
  for (int j = 3; j < 6; ++j) {
    for (int i = 3; i < 6; ++i) map.set_label({i, j, 4}, Label::Occluded);
  }
  return map;
}

std::vector<UnseenVoxel> hole(UnseenFrom from) {
  std::vector<UnseenVoxel> unseen;
  for (int j = 3; j < 6; ++j) {
    for (int i = 3; i < 6; ++i) unseen.push_back({{i, j, 4}, 1, from});
  }
  return unseen;
}

TEST(RecoveredPicture, ColoursWhatRemainsUnseenByWhereItCouldBeLookedAtFrom) {
  const VoxelMap map = plate_with_hole();
  const Picture white = recovered_picture(map, {}, kFromAbove);
  EXPECT_EQ(pixels_of(white, false, false, true), 0);
  const auto in_view = hole(UnseenFrom::InView);
  const Picture blue = recovered_picture(map, {{}, in_view, {}}, kFromAbove);
  EXPECT_GT(pixels_of(blue, false, false, true), 200) << "a ninth of the floor";
  const auto refused = hole(UnseenFrom::Refused);
  const Picture magenta = recovered_picture(map, {{}, refused, {}}, kFromAbove);
  EXPECT_EQ(pixels_of(magenta, false, false, true), 0);
  EXPECT_GT(pixels_of(magenta, true, false, true), 200);
}

TEST(RecoveredPicture, TellsUnseenFromNeverVisible) {
  const VoxelMap map = plate_with_hole();
  // Surface in three voxels of the hole: in the first it can be seen, in the second it cannot, in
  // the third some of it can. And in one that is Occupied, and one outside the map.
  const std::vector<Eigen::Vector3f> samples = {
      {0.3F, 0.3F, 0.4F}, {0.4F, 0.4F, 0.4F}, {0.5F, 0.5F, 0.4F}, {0.5F, 0.52F, 0.4F},
      {0.1F, 0.1F, 0.4F}, {0.2F, 0.1F, 0.4F}, {9.0F, 9.0F, 9.0F}};
  const std::vector<Eigen::Vector3f> visible = {samples[0], samples[2], samples[4]};
  const MissedSurface missed = missed_surface(map, samples, visible);
  EXPECT_EQ(missed.can_be_seen, (std::vector<VoxelIndex>{{3, 3, 4}, {5, 5, 4}}));
  EXPECT_EQ(missed.never_visible, (std::vector<VoxelIndex>{{4, 4, 4}}));

  const auto unseen = hole(UnseenFrom::InView);
  const Picture untold = recovered_picture(map, {{}, unseen, {}}, kFromAbove);
  const Picture told = recovered_picture(map, {{}, unseen, missed}, kFromAbove);
  EXPECT_EQ(pixels_of(untold, true, false, false), 0);
  EXPECT_GT(pixels_of(told, true, false, false), 10) << "two cubes";
  const int fewer = pixels_of(untold, false, false, true) - pixels_of(told, false, false, true);
  EXPECT_GT(fewer, 20) << "one face is grey";
}

TEST(RecoveredPicture, HasALegendOfWhatIsInIt) {
  const VoxelMap map = plate_with_hole();
  const auto unseen = hole(UnseenFrom::TooNear);
  const auto text_of = [&](const DrawnRun& run) {
    std::string text;
    for (const LegendLine& line : legend_of(map, run)) text += line.text + "\n";
    return text;
  };
  const std::string untold = text_of({{}, unseen, {}});
  EXPECT_NE(untold.find("0.09 m\u00b2 unseen at the end, and to be seen only from too near"),
            std::string::npos)
      << untold;
  EXPECT_EQ(untold.find("refused"), std::string::npos) << untold;
  EXPECT_NE(untold.find("white gaps"), std::string::npos) << untold;
  EXPECT_NE(untold.find("not told from what is unseen"), std::string::npos) << untold;
  const std::string told = text_of({{}, unseen, MissedSurface{{{3, 3, 4}}, {{4, 4, 4}}}});
  EXPECT_NE(told.find("0.08 m\u00b2 unseen at the end"), std::string::npos) << told;
  EXPECT_NE(told.find("0.01 m\u00b2 never visible"), std::string::npos) << told;
  EXPECT_NE(told.find("cubes: 1 voxels"), std::string::npos) << told;
}

TEST(RecoveredPicture, IsWrittenAsPng) {
  const std::string file = ::testing::TempDir() + "nextview_picture_test.png";
  const std::vector<LegendLine> legend = {{{1, 0, 0}, {0, 0, 1}, "red to blue"}};
  write_png({2, 1, {255, 0, 0, 0, 0, 255}}, legend, file);
  std::ifstream in(file, std::ios::binary);
  std::array<char, 4> head{};
  in.read(head.data(), 4);
  EXPECT_EQ(std::string(&head[1], 3), "PNG");
  EXPECT_THROW(write_png({2, 1, {255, 0, 0, 0, 0, 255}}, {}, "/no/such/folder/x.png"),
               std::runtime_error);
}

}  // namespace
}  // namespace nextview
