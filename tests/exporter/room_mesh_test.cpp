// The mesh of whole runs in both rooms, held against their CAD models, in every format.
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "exporter/mesh_simplifier.h"
#include "exporter/oriented_points.h"
#include "exporter/recovered_mesh.h"
#include "logger/recovered_run.h"
#include "scene/mesh_file.h"
#include "scene/scene.h"
#include "scene/scene_catalog.h"
#include "tests/exporter/exported.h"
#include "tests/exporter/surface_checks.h"

namespace nextview {
namespace {

constexpr double kVoxel_m = 0.10;

std::filesystem::path scenes_folder() {
  return std::filesystem::path(NEXTVIEW_SOURCE_DIR) / "scenes";
}

/// How far points of a mesh are from a scene, every point standing for the same area.
struct Distances {
  double mean_m = 0.0;
  double percentile_95_m = 0.0;
  double largest_m = 0.0;
};

/// Some 400 points a square metre, at the fractions of the golden ratio and its like (R2 sequence).
Distances distances_to(const TriangleMesh& mesh, const Scene& scene) {
  constexpr double kPointsPerM2 = 400.0;
  std::vector<double> distances_m;
  double owed = 0.0;
  double u = 0.5, v = 0.5;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Eigen::Vector3d a = mesh.corner_m(i, 0);
    const Eigen::Vector3d ab = mesh.corner_m(i, 1) - a;
    const Eigen::Vector3d ac = mesh.corner_m(i, 2) - a;
    for (owed += kPointsPerM2 * 0.5 * ab.cross(ac).norm(); owed >= 1.0; owed -= 1.0) {
      u = std::fmod(u + 0.7548776662466927, 1.0);
      v = std::fmod(v + 0.5698402909980532, 1.0);
      const bool beyond = u + v > 1.0;
      const Eigen::Vector3d p = a + (beyond ? 1.0 - u : u) * ab + (beyond ? 1.0 - v : v) * ac;
      distances_m.push_back(scene.clearance_m(p, p, 10.0));
    }
  }
  std::sort(distances_m.begin(), distances_m.end());
  Distances result;
  for (const double distance_m : distances_m) result.mean_m += distance_m;
  result.mean_m /= static_cast<double>(distances_m.size());
  result.percentile_95_m = distances_m[distances_m.size() * 95 / 100];
  result.largest_m = distances_m.back();
  return result;
}

double mean_side_m(const SurfaceMesh& mesh) {
  double sum_m = 0.0;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      sum_m += (mesh.vertices_m[triangle[k]] - mesh.vertices_m[triangle[(k + 1) % 3]]).norm();
    }
  }
  return sum_m / (3.0 * static_cast<double>(mesh.triangles.size()));
}

class RoomMesh : public testing::TestWithParam<std::string> {};

/// The mesh lies on the CAD model to within half a voxel, before and after it is simplified.
TEST_P(RoomMesh, LiesOnTheCadModel) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_program({program_path("nextview_run"), GetParam(), "--strategy", "paper",
                         "--no-coverage", "--out", (folder / "run").string()})
                .status,
            0);
  const SceneDescription room = find_scene(GetParam(), scenes_folder());
  const Scene scene(load_mesh(room.file, room.options));
  std::size_t before = 0;
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{}, std::vector<std::string>{"--error", "0.01"},
        std::vector<std::string>{"--triangles", "3000"}}) {
    const TriangleMesh mesh =
        load_mesh(exported(folder, "mesh.ply", folder / "run", options), SceneOptions{});
    const Distances distances = distances_to(mesh, scene);
    const std::string what = options.empty() ? "as extracted" : options[0] + " " + options[1];
    std::cout << GetParam() << ", " << what << ": " << mesh.triangles.size() << " triangles, "
              << mesh.area_m2() << " m2; mm to the CAD model: mean " << 1e3 * distances.mean_m
              << ", 95th percentile " << 1e3 * distances.percentile_95_m << ", largest "
              << 1e3 * distances.largest_m << std::endl;
    EXPECT_LT(distances.mean_m, 0.5 * kVoxel_m) << what;
    EXPECT_LT(distances.percentile_95_m, 0.5 * kVoxel_m) << what;
    if (options.empty()) before = mesh.triangles.size();
  }
  EXPECT_GT(before, 5000U);

  const RecoveredRun run = recover_run(folder / "run");
  OrientedPoints points(run.builder.map().grid());
  for (const ReceivedRangeImage* received : run.images) points.add(received->image);
  const SurfaceMesh mesh = recovered_mesh(run.builder.map(), points);
  EXPECT_EQ(mesh.triangles.size(), before) << "nothing is lost on the way into the file and back";
  EXPECT_NEAR(mean_side_m(mesh), kVoxel_m, 0.2 * kVoxel_m) << "triangles are about voxel-sized";
  for (const SurfaceMesh& each :
       {mesh, simplified(mesh, {{}, 0.01}), simplified(mesh, {3000, {}})}) {
    const SurfaceFaults faults = faults_of(each, 1e-6);
    EXPECT_EQ(faults.edges_run_twice, 0) << each.triangles.size();
    EXPECT_EQ(faults.low_triangles, 0) << each.triangles.size();
    EXPECT_EQ(faults.unused_vertices, 0) << each.triangles.size();
  }
}

constexpr const char* kFormats[] = {"mesh.ply", "mesh.obj", "mesh.gltf", "mesh.glb"};

/// What a file that nextview_export has made of the short log must hold.
void expect_file(const Said& said, const SurfaceMesh& mesh) {
  double area_m2 = 0.0, volume_m3 = 0.0;
  Eigen::Vector3d min = Eigen::Vector3d::Constant(1e9);
  for (const auto& t : mesh.triangles) {
    area_m2 += 0.5 * area_vector_m2(mesh, t).norm();
    volume_m3 += mesh.vertices_m[t[0]].cast<double>().dot(area_vector_m2(mesh, t)) / 6.0;
  }
  for (const auto& vertex : mesh.vertices_m) min = min.cwiseMin(vertex.cast<double>());
  EXPECT_EQ(said.at("triangles").at(0), std::to_string(mesh.triangles.size()));
  EXPECT_EQ(said.at("vertices").at(0), std::to_string(mesh.vertices_m.size()));
  EXPECT_NEAR(std::stod(said.at("area").at(0)), area_m2, 1e-4);
  EXPECT_NEAR(std::stod(said.at("volume").at(0)), volume_m3, 1e-4);
  EXPECT_NE(volume_m3, 0.0);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(std::stod(said.at("min").at(k)), min[static_cast<int>(k)], 1e-5);
  }
}

SurfaceMesh short_mesh() {
  const RecoveredRun run = recover_run(short_log());
  OrientedPoints points(run.builder.map().grid());
  for (const ReceivedRangeImage* received : run.images) points.add(received->image);
  return recovered_mesh(run.builder.map(), points);
}

TEST(MeshFiles, AreWhatPythonReads) {
  NEXTVIEW_NEEDS_PROGRAM("python3", "python3");
  const TemporaryFolder folder;
  const std::string reader =
      (std::filesystem::path(NEXTVIEW_SOURCE_DIR) / "tests/exporter/read_mesh.py").string();
  for (const char* format : kFormats) {
    SCOPED_TRACE(format);
    expect_file(say({"/usr/bin/env", "python3", reader, exported(folder, format).string()}),
                short_mesh());
  }
}

TEST(MeshFiles, AreReadByAssimp) {
  NEXTVIEW_NEEDS_PROGRAM("assimp", "assimp-utils");
  const TemporaryFolder folder;
  const std::string triangles = std::to_string(short_mesh().triangles.size());
  for (const char* format : kFormats) {
    const Outcome info =
        run_program({"/usr/bin/env", "assimp", "info", exported(folder, format).string()});
    EXPECT_EQ(info.status, 0);
    EXPECT_NE(info.output.find("Faces:              " + triangles), std::string::npos)
        << info.output;
  }
}

TEST(MeshFiles, ThatCannotBeWrittenAreNamed) {
  for (const char* format : kFormats) {
    const std::string file = std::string("/no/such/folder/") + format;
    const Outcome outcome = run_program(
        {program_path("nextview_export"), short_log().string(), "--to", format, "--out", file});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.output.find(file + ": cannot be written"), std::string::npos)
        << outcome.output;
  }
}

INSTANTIATE_TEST_SUITE_P(Both, RoomMesh, testing::Values("boxes", "columns"));

}  // namespace
}  // namespace nextview
