// Points, poses and views as files, read back by programs that are not ours.
#include <gtest/gtest.h>

#include <algorithm>

#include <cmath>
#include <fstream>
#include <sstream>

#include "exporter/one_voxel_holes.h"
#include "exporter/point_clouds.h"
#include "exporter/trajectory.h"
#include "logger/recovered_run.h"
#include "tests/exporter/exported.h"

namespace nextview {
namespace {

std::string python_reader() {
  return (std::filesystem::path(NEXTVIEW_SOURCE_DIR) / "tests/exporter/read_points.py").string();
}

/// Smallest, largest and sum of a field's values.
struct Range {
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();
  double sum = 0.0;
  void add(double value) {
    min = std::min(min, value);
    max = std::max(max, value);
    sum += value;
  }
};

void expect_range(const Said& said, const std::string& field, const Range& range) {
  ASSERT_TRUE(said.contains(field)) << field;
  const std::vector<std::string>& values = said.at(field);
  ASSERT_EQ(values.size(), 3U);
  EXPECT_NEAR(std::stod(values[0]), range.min, 1e-6) << field;
  EXPECT_NEAR(std::stod(values[1]), range.max, 1e-6) << field;
  EXPECT_NEAR(std::stod(values[2]), range.sum, 1e-3 + 1e-6 * std::abs(range.sum)) << field;
}

std::vector<std::vector<std::string>> rows_of(const std::filesystem::path& file, char separator) {
  std::ifstream in(file);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("#")) continue;
    std::istringstream cells(line);
    std::vector<std::string>& row = rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, separator);) row.push_back(cell);
  }
  return rows;
}

TEST(OccupiedVoxels, AreWhatPythonReadsFromPlyAndPcd) {
  NEXTVIEW_NEEDS_PROGRAM("python3", "python3");
  const TemporaryFolder folder;
  const RecoveredRun run = recover_run(short_log());
  const VoxelMap& map = run.builder.map();
  Range x, z, normal_z, quality;
  int occupied = 0;
  for_each_voxel(map.window(), [&](const VoxelIndex& voxel) {
    if (map.label(voxel) != Label::Occupied) return;
    ++occupied;
    x.add(map.grid().center_m(voxel).x());
    z.add(map.grid().center_m(voxel).z());
    normal_z.add(map.surface(voxel)->mean_normal().z());
    quality.add(map.surface(voxel)->quality_01());
  });
  ASSERT_GT(occupied, 500);
  for (const auto& [format, normal_name] :
       {std::pair("voxels.ply", "nz"), std::pair("voxels.pcd", "normal_z")}) {
    const Said said =
        say({"/usr/bin/env", "python3", python_reader(), exported(folder, format).string()});
    EXPECT_EQ(said.at("points").at(0), std::to_string(occupied)) << format;
    EXPECT_EQ(said.at("bytes_left").at(0), "0") << format;
    expect_range(said, "x", x);
    expect_range(said, "z", z);
    expect_range(said, normal_name, normal_z);
    expect_range(said, "quality", quality);
  }
}

TEST(OccupiedVoxels, ComeWithTheHolesOfOneVoxelWhenAskedFor) {
  NEXTVIEW_NEEDS_PROGRAM("python3", "python3");
  const TemporaryFolder folder;
  const RecoveredRun run = recover_run(short_log());
  const std::size_t holes = one_voxel_holes(run.builder.map()).size();
  ASSERT_GT(holes, 0U) << "the coarse sensor of the log leaves some";
  for (const std::string format : {"voxels.ply", "voxels.pcd"}) {
    const auto read = [&](const std::vector<std::string>& more) {
      return say({"/usr/bin/env", "python3", python_reader(),
                  exported(folder, format, short_log(), more).string()});
    };
    const Said sensed = read({});
    const Said filled = read({"--fill-holes"});
    EXPECT_FALSE(sensed.contains("filled"));
    EXPECT_EQ(std::stoul(filled.at("points").at(0)), std::stoul(sensed.at("points").at(0)) + holes);
    EXPECT_EQ(filled.at("filled"), (std::vector<std::string>{"0", "1", std::to_string(holes)}));
    EXPECT_EQ(filled.at("bytes_left").at(0), "0");
    EXPECT_EQ(filled.at("quality").at(2), sensed.at("quality").at(2)) << "they have none";
  }
}

TEST(SensedPoints, AreWhatPythonReadsFromPlyAndPcd) {
  NEXTVIEW_NEEDS_PROGRAM("python3", "python3");
  const TemporaryFolder folder;
  const RecoveredRun run = recover_run(short_log());
  Range y, normal_x, view;
  int points = 0;
  for (const ReceivedRangeImage* received : run.images) {
    for_each_point(received->image, [&](const SensedPoint& point) {
      ++points;
      y.add(point.position_m.y());
      normal_x.add(point.normal.x());
      view.add(received->view);
    });
  }
  ASSERT_EQ(points, 8 * 24 * 12) << "every ray of every view meets something in a closed room";
  for (const auto& [format, normal_name] :
       {std::pair("points.ply", "nx"), std::pair("points.pcd", "normal_x")}) {
    const Said said =
        say({"/usr/bin/env", "python3", python_reader(), exported(folder, format).string()});
    EXPECT_EQ(said.at("points").at(0), std::to_string(points)) << format;
    EXPECT_EQ(said.at("bytes_left").at(0), "0") << format;
    expect_range(said, "y", y);
    expect_range(said, normal_name, normal_x);
    expect_range(said, "view", view);
  }
}

/// PCL reads them, and what it writes of them is the same to Python.
TEST(PointClouds, AreReadByPcl) {
  NEXTVIEW_NEEDS_PROGRAM("python3", "python3");
  NEXTVIEW_NEEDS_PROGRAM("pcl_ply2pcd", "pcl-tools");
  const TemporaryFolder folder;
  const std::string by_pcl = (folder / "by_pcl.pcd").string();
  for (const std::string name : {"voxels", "points"}) {
    const std::string pcd = exported(folder, name + ".pcd").string();
    const std::string ply = exported(folder, name + ".ply").string();
    const Said ours = say({"/usr/bin/env", "python3", python_reader(), pcd});
    for (const std::vector<std::string>& convert :
         {std::vector<std::string>{"pcl_convert_pcd_ascii_binary", pcd, by_pcl, "1"},
          std::vector<std::string>{"pcl_ply2pcd", "-format", "1", ply, by_pcl}}) {
      std::vector<std::string> arguments = {"/usr/bin/env"};
      arguments.insert(arguments.end(), convert.begin(), convert.end());
      std::filesystem::remove(by_pcl);
      EXPECT_EQ(run_program(arguments).status, 0);
      Said pcls = say({"/usr/bin/env", "python3", python_reader(), by_pcl});
      pcls["bytes_left"] = ours.at("bytes_left");  // PCL fills up the last page of memory
      EXPECT_EQ(pcls, ours) << convert[0];
    }
  }
}

TEST(SensedPoints, LieWhereTheRaysEnd) {
  RangeImage image;
  image.rays = make_ray_table(TiltedLineScan::with_aperture(3, 3, 0.2));
  image.position_m = Eigen::Vector3d(1.0, 2.0, 3.0);
  image.world_from_sensor = world_from_sensor_rotation(std::numbers::pi / 2.0, 0.0);
  image.range_m.assign(9, std::numeric_limits<float>::infinity());
  image.range_m[4] = 2.0F;  // straight ahead, which after a quarter turn left is -x
  image.range_m[0] = std::numeric_limits<float>::quiet_NaN();
  image.range_m[8] = 0.001F;  // nearer than the sensor can tell
  std::vector<SensedPoint> points;
  for_each_point(image, [&](const SensedPoint& point) { points.push_back(point); });
  ASSERT_EQ(points.size(), 1U);
  EXPECT_TRUE(points[0].position_m.isApprox(Eigen::Vector3d(-1.0, 2.0, 3.0), 1e-12));
  EXPECT_TRUE(points[0].normal.isZero()) << "it has no neighbour";
}

TEST(Trajectory, TurnsTheSensorsForwardWhereTheViewLooks) {
  StampedPose pose;
  pose.world_from_sensor = world_from_sensor_rotation(2.5, -0.7);
  const Eigen::Quaterniond q = quaternion_of(pose);
  EXPECT_GE(q.w(), 0.0);
  EXPECT_TRUE((q * Eigen::Vector3d::UnitY()).isApprox(viewing_direction(2.5, -0.7), 1e-12));
}

TEST(Trajectory, HasAPoseOfEveryViewInCsvAndTum) {
  const TemporaryFolder folder;
  const RecoveredRun run = recover_run(short_log());
  const auto csv = rows_of(exported(folder, "poses.csv"), ',');
  const auto tum = rows_of(exported(folder, "poses.tum"), ' ');
  ASSERT_EQ(csv.size(), run.images.size() + 1);
  ASSERT_EQ(tum.size(), run.images.size());
  for (std::size_t i = 0; i < run.images.size(); ++i) {
    const ReceivedRangeImage& received = *run.images[i];
    ASSERT_EQ(csv[i + 1].size(), 11U);
    ASSERT_EQ(tum[i].size(), 8U);
    EXPECT_EQ(std::stoi(csv[i + 1][0]), received.view);
    EXPECT_EQ(tum[i][0], csv[i + 1][1]);
    for (std::size_t k = 0; k < 3; ++k) {
      const double position_m = received.image.position_m[static_cast<int>(k)];
      EXPECT_NEAR(std::stod(csv[i + 1][2 + k]), position_m, 1e-6);
      EXPECT_NEAR(std::stod(tum[i][1 + k]), position_m, 1e-6);
    }
    EXPECT_NEAR(
        std::sin(std::stod(csv[i + 1][5]) * std::numbers::pi / 180.0 - received.image.pose.pan_rad),
        0.0, 1e-6);
    EXPECT_NEAR(std::stod(csv[i + 1][6]) * std::numbers::pi / 180.0, received.image.pose.tilt_rad,
                1e-6);
    const Eigen::Quaterniond q(std::stod(tum[i][7]), std::stod(tum[i][4]), std::stod(tum[i][5]),
                               std::stod(tum[i][6]));
    EXPECT_NEAR((q.toRotationMatrix() - received.image.world_from_sensor).norm(), 0.0, 1e-7);
  }
}

/// The log alone gives the table that the run has written, but for the CAD model's columns.
TEST(Views, AreThoseOfTheRun) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_views(folder / "run", 4, {"--no-coverage"}).status, 0);
  const auto ours = rows_of(exported(folder, "views.csv", folder / "run"), ',');
  auto of_the_run = rows_of(folder / "run" / "views.csv", ',');
  const auto precision = std::ranges::find(of_the_run.front(), "surface_precision");
  ASSERT_NE(precision, of_the_run.front().end());
  const auto column = static_cast<std::size_t>(precision - of_the_run.front().begin());
  for (std::size_t i = 1; i < of_the_run.size(); ++i) of_the_run[i].at(column).clear();
  EXPECT_EQ(ours, of_the_run);
  EXPECT_EQ(ours.size(), 5U);
}

TEST(Export, TakesTheFirstViewsOnly) {
  const TemporaryFolder folder;
  EXPECT_EQ(rows_of(exported(folder, "poses.tum", short_log(), {"--views", "3"}), ' ').size(), 3U);
  EXPECT_EQ(rows_of(exported(folder, "views.csv", short_log(), {"--views", "3"}), ',').size(), 4U);
}

void expect_refusal(const std::vector<std::string>& arguments, const std::string& words) {
  std::vector<std::string> all = {program_path("nextview_export")};
  all.insert(all.end(), arguments.begin(), arguments.end());
  const Outcome outcome = run_program(all);
  EXPECT_NE(outcome.status, 0);
  EXPECT_NE(outcome.output.find(words), std::string::npos) << outcome.output;
}

TEST(Export, SaysWhatIsWrong) {
  const TemporaryFolder folder;
  const std::string log = short_log().string();
  expect_refusal({(folder / "nowhere").string(), "--to", "voxels.ply"}, "nowhere: no such folder");
  expect_refusal({folder.path().string(), "--to", "voxels.ply"}, "run.lcmlog: no such file");
  std::ofstream(folder / "run.lcmlog") << "this is no log";
  expect_refusal({folder.path().string(), "--to", "voxels.ply"},
                 "run.lcmlog: no run's configuration is in the log");
  expect_refusal({log, "--to", "voxels.ply", "--run", "7"}, "with the number 7");
  expect_refusal({log, "--to", "voxels.xyz"}, "--to: voxels.xyz not in {");
  expect_refusal({log, "--to", "voxels.ply", "poses.csv", "--out", "x"}, "--out names one file");
  expect_refusal({log, "--to", "voxels.ply", "--out", "/no/such/folder/x.ply"},
                 "/no/such/folder/x.ply: cannot be written; does its folder exist?");
  expect_refusal({log, "--to", "points.ply", "--out", "/dev/full"},
                 "/dev/full: could not be written in whole; disk full?");
}

}  // namespace
}  // namespace nextview
