// OctoMap trees and MCAP files, read back by programs that are not ours.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "exporter/foxglove_json.h"
#include "exporter/mcap_writer.h"
#include "exporter/point_clouds.h"
#include "logger/recovered_run.h"
#include "tests/exporter/exported.h"

namespace nextview {
namespace {

/// The cubes that bt2vrml has drawn: where their middles are and how long their sides, in 1/8
/// voxels.
std::map<std::array<int, 3>, int> cubes_of(const std::filesystem::path& vrml, double unit_m) {
  std::ifstream in(vrml);
  std::map<std::array<int, 3>, int> cubes;
  const auto in_units = [unit_m](double value_m) {
    EXPECT_NEAR(value_m / unit_m, std::round(value_m / unit_m), 1e-3);
    return static_cast<int>(std::lround(value_m / unit_m));
  };
  for (std::string line; std::getline(in, line);) {
    double x = 0.0, y = 0.0, z = 0.0, side = 0.0;
    if (std::sscanf(line.c_str(), "Transform { translation %lf %lf %lf", &x, &y, &z) != 3) continue;
    std::getline(in, line);
    if (std::sscanf(line.c_str(), " children [ Shape { geometry Box { size %lf", &side) != 1) {
      ADD_FAILURE() << line;
      continue;
    }
    cubes[{in_units(x), in_units(y), in_units(z)}] = in_units(side);
  }
  return cubes;
}

/// Leaves a test of trees out, and says so, where nextview_export was built without OctoMap.
#ifdef NEXTVIEW_HAS_OCTOMAP
#define NEXTVIEW_NEEDS_OCTOMAP()
#else
#define NEXTVIEW_NEEDS_OCTOMAP()                                                               \
  GTEST_SKIP() << "nextview_export was built without OctoMap: apt-get install liboctomap-dev " \
                  "and configure again"
#endif

TEST(OctoMapTree, IsWhatOctoMapsOwnToolReads) {
  NEXTVIEW_NEEDS_OCTOMAP();
  NEXTVIEW_NEEDS_PROGRAM("bt2vrml", "octomap-tools");
  const TemporaryFolder folder;
  const RecoveredRun run = recover_run(short_log());
  const VoxelMap& map = run.builder.map();
  ASSERT_TRUE(map.grid().origin_m.isZero());
  const Outcome read =
      run_program({"/usr/bin/env", "bt2vrml", exported(folder, "octomap.bt").string()});
  ASSERT_EQ(read.status, 0) << read.output;
  // Eighths of a voxel, so that the middles of cells of half a voxel are whole numbers.
  const auto cubes = cubes_of(folder / "octomap.bt.wrl", map.grid().voxel_size_m / 8.0);
  std::int64_t occupied = 0;
  for_each_voxel(map.window(),
                 [&](const VoxelIndex& voxel) { occupied += map.label(voxel) == Label::Occupied; });
  std::int64_t volume = 0;
  for (const auto& [middle, side] : cubes) {
    volume += std::int64_t{side} * side * side;
    // Every cell of a cube lies in an Occupied voxel.
    for (int z = -side / 2 + 2; z < side / 2; z += 4) {
      for (int y = -side / 2 + 2; y < side / 2; y += 4) {
        for (int x = -side / 2 + 2; x < side / 2; x += 4) {
          const Eigen::Vector3d at =
              Eigen::Vector3d(middle[0] + x, middle[1] + y, middle[2] + z) / 8.0;
          ASSERT_EQ(map.label(at.array().round().cast<int>()), Label::Occupied);
        }
      }
    }
  }
  EXPECT_GT(occupied, 500);
  EXPECT_EQ(volume, occupied * 8 * 8 * 8) << "no Occupied voxel is missing";
}

/// OctoMap reads the whole tree, free space too, and finds it equal to itself.
TEST(OctoMapTree, IsConvertedByOctoMap) {
  NEXTVIEW_NEEDS_OCTOMAP();
  NEXTVIEW_NEEDS_PROGRAM("convert_octree", "octomap-tools");
  const TemporaryFolder folder;
  const std::string tree = exported(folder, "octomap.bt").string();
  const std::string full = (folder / "full.ot").string();
  const std::string again = (folder / "again.bt").string();
  ASSERT_EQ(run_program({"/usr/bin/env", "convert_octree", tree, full}).status, 0);
  ASSERT_EQ(run_program({"/usr/bin/env", "convert_octree", full, again}).status, 0);
  const auto bytes = [](const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream all;
    all << in.rdbuf();
    return all.str();
  };
  EXPECT_EQ(bytes(again), bytes(tree));
  EXPECT_GT(bytes(tree).size(), 1000U);
}

/// Built without it, the program says what to install.
TEST(OctoMapTree, IsWrittenOrSaidToNeedOctoMap) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "octomap.bt";
  const Outcome outcome = run_program({program_path("nextview_export"), short_log().string(),
                                       "--to", "octomap.bt", "--out", file.string()});
#ifdef NEXTVIEW_HAS_OCTOMAP
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_TRUE(std::filesystem::exists(file));
#else
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  EXPECT_NE(outcome.output.find("octomap.bt: this program was built without OctoMap; install "
                                "liboctomap-dev"),
            std::string::npos)
      << outcome.output;
  EXPECT_FALSE(std::filesystem::exists(file));
#endif
}

TEST(Mcap, IsWhatPythonReads) {
  NEXTVIEW_NEEDS_PROGRAM("python3", "python3");
  const TemporaryFolder folder;
  const RecoveredRun run = recover_run(short_log());
  const std::string reader =
      (std::filesystem::path(NEXTVIEW_SOURCE_DIR) / "tests/exporter/read_mcap.py").string();
  const Said said = say({"/usr/bin/env", "python3", reader, exported(folder, "run.mcap").string()});
  const std::string views = std::to_string(run.images.size());
  for (const auto& [topic, schema] :
       {std::pair("/tf", "foxglove.FrameTransform"),
        std::pair("/sensor_pose", "foxglove.PoseInFrame"),
        std::pair("/scan", "foxglove.PointCloud"), std::pair("/map", "foxglove.PointCloud"),
        std::pair("/path", "foxglove.SceneUpdate"), std::pair("/figures", "nextview.View")}) {
    EXPECT_EQ(said.at(topic), (std::vector<std::string>{views, schema}));
  }
  EXPECT_EQ(said.at("/log").at(0), std::to_string(run.images.size() + 1)) << "and the run's end";
  EXPECT_EQ(said.at("end").at(0), run.log.record().stop()->stop_reason + ":");

  const ReceivedRangeImage& last = *run.images.back();
  double sum_x = 0.0;
  int points = 0;
  for_each_point(last.image, [&](const SensedPoint& point) {
    ++points;
    sum_x += point.position_m.x();
  });
  EXPECT_EQ(said.at("points/scan").at(0), std::to_string(points));
  EXPECT_NEAR(std::stod(said.at("points/scan").at(1)), sum_x, 1e-3);
  EXPECT_EQ(
      said.at("points/map").at(0),
      std::to_string(run.builder.statistics().voxels[static_cast<std::size_t>(Label::Occupied)]));
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(std::stod(said.at("pose").at(k)), last.image.position_m[static_cast<int>(k)], 1e-9);
  }
  const Eigen::Quaterniond q(std::stod(said.at("pose").at(6)), std::stod(said.at("pose").at(3)),
                             std::stod(said.at("pose").at(4)), std::stod(said.at("pose").at(5)));
  EXPECT_NEAR((q.toRotationMatrix() - last.image.world_from_sensor).norm(), 0.0, 1e-9);
  EXPECT_EQ(said.at("time").at(0), std::to_string(last.utime * 1000));
}

/// A file of many chunks, which the reader holds against their index.
TEST(Mcap, HasChunksThatAreIndexed) {
  NEXTVIEW_NEEDS_PROGRAM("python3", "python3");
  const TemporaryFolder folder;
  ASSERT_EQ(run_views(folder / "run", 12, {"--no-coverage"}).status, 0);
  const std::string reader =
      (std::filesystem::path(NEXTVIEW_SOURCE_DIR) / "tests/exporter/read_mcap.py").string();
  const std::filesystem::path file = exported(folder, "run.mcap", folder / "run");
  EXPECT_GT(std::filesystem::file_size(file), 1U << 20) << "more than a chunk";
  EXPECT_EQ(say({"/usr/bin/env", "python3", reader, file.string()}).at("/map").at(0), "12");
}

TEST(Mcap, RefusesMessagesOutOfOrder) {
  std::ostringstream out;
  McapWriter writer(out);
  const std::uint16_t channel = writer.add_json_channel("/a", "nextview.A", "{}");
  writer.write(channel, 2, "{}");
  EXPECT_THROW(writer.write(channel, 1, "{}"), std::invalid_argument);
  EXPECT_THROW(writer.write(9, 3, "{}"), std::out_of_range);
}

TEST(Foxglove, HasNoSchemaOfAnUnknownName) {
  EXPECT_THROW(foxglove::schema("foxglove.NoSuchThing"), std::invalid_argument);
}

}  // namespace
}  // namespace nextview
