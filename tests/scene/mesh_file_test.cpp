#include "scene/mesh_file.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <thread>
#include <vector>

#include "scene/cad_file.h"

#include "tests/scene/scene_error.h"
#include "tests/scene/test_worlds.h"

namespace nextview {
namespace {

std::string load_failure(const std::string& name) {
  return message_of([&] { load_mesh(kDataFolder / name); });
}

/// Of those who read for load_mesh, none may stay behind.
bool no_child_is_left() { return ::waitpid(-1, nullptr, WNOHANG) < 0 && errno == ECHILD; }

void expect_triangle(const TriangleMesh& mesh, std::size_t triangle, const Eigen::Vector3d& a,
                     const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  ASSERT_LT(triangle, mesh.triangles.size());
  EXPECT_LT((mesh.corner_m(triangle, 0) - a).norm(), 1e-6) << mesh.corner_m(triangle, 0);
  EXPECT_LT((mesh.corner_m(triangle, 1) - b).norm(), 1e-6) << mesh.corner_m(triangle, 1);
  EXPECT_LT((mesh.corner_m(triangle, 2) - c).norm(), 1e-6) << mesh.corner_m(triangle, 2);
}

TEST(LoadMesh, ErrorsNameTheFileAndWhatToDo) {
  EXPECT_NE(load_failure("absent.obj").find("absent.obj: no such file"), std::string::npos);
  EXPECT_NE(load_failure("not_cad.txt").find("not_cad.txt: cannot be read as a CAD file"),
            std::string::npos);
  EXPECT_NE(load_failure("not_cad.txt").find("convert it"), std::string::npos);
  EXPECT_NE(load_failure("broken.stl").find("broken.stl: "), std::string::npos)
      << load_failure("broken.stl");
  EXPECT_NE(load_failure("no_triangles.obj").find("no_triangles.obj: has no triangles"),
            std::string::npos);
  EXPECT_NE(load_failure("not_finite.ply")
                .find("not_finite.ply: triangle 0 has a coordinate that "
                      "is not finite"),
            std::string::npos)
      << load_failure("not_finite.ply");
  EXPECT_NE(load_failure("").find("is a folder"), std::string::npos);
}

TEST(LoadMesh, RefusesAUnitThatIsNoLength) {
  for (const double unit_m : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(load_mesh(kDataFolder / "triangle.ply", {.unit_m = unit_m}), SceneError);
  }
  // A unit so large that coordinates overflow.
  EXPECT_THROW(load_mesh(kDataFolder / "triangle.ply", {.unit_m = 1e39}), SceneError);
}

TEST(LoadMesh, ReadsCommonFormatsAsZUpMetresByDefault) {
  for (const char* name : {"triangle.ply", "triangle.stl", "triangle_points_lines.obj"}) {
    SCOPED_TRACE(name);
    const TriangleMesh mesh = load_mesh(kDataFolder / name);
    ASSERT_EQ(mesh.triangles.size(), 1U);
    EXPECT_EQ(mesh.vertices_m.size(), 3U);
    expect_triangle(mesh, 0, {0, 0, 0}, {1, 0, 0}, {0, 2, 3});
  }
}

TEST(LoadMesh, UnitAndUpAreAsAsked) {
  const auto file = kDataFolder / "triangle.ply";
  expect_triangle(load_mesh(file, {.unit_m = 0.01}), 0, {0, 0, 0}, {.01, 0, 0}, {0, .02, .03});
  expect_triangle(load_mesh(file, {.up = UpAxis::Y}), 0, {0, 0, 0}, {1, 0, 0}, {0, -3, 2});
  expect_triangle(load_mesh(file, {.up = UpAxis::X}), 0, {0, 0, 0}, {0, 0, 1}, {-2, -3, 0});
  expect_triangle(load_mesh(file, {.up = UpAxis::Z}), 0, {0, 0, 0}, {1, 0, 0}, {0, 2, 3});
}

// All of it once: the axis, the centimetres and the nodes' transforms.
TEST(LoadMesh, ColladaSaysItsOwnAxisAndUnit) {
  const TriangleMesh z_up = load_mesh(kDataFolder / "z_up.dae");
  ASSERT_EQ(z_up.triangles.size(), 2U);
  expect_triangle(z_up, 0, {0, 0, 0}, {1, 0, 0}, {0, 2, 3});
  expect_triangle(z_up, 1, {4, 0, 0}, {5, 0, 0}, {4, 2, 3});

  const TriangleMesh y_up = load_mesh(kDataFolder / "y_up.dae");
  ASSERT_EQ(y_up.triangles.size(), 2U);
  expect_triangle(y_up, 0, {0, 0, 0}, {1, 0, 0}, {0, -3, 2});
  expect_triangle(y_up, 1, {4, 0, 0}, {5, 0, 0}, {4, -3, 2});

  const TriangleMesh x_up = load_mesh(kDataFolder / "x_up.dae");
  ASSERT_EQ(x_up.triangles.size(), 2U);
  expect_triangle(x_up, 0, {0, 0, 0}, {0, 0, 1}, {-2, -3, 0});
  expect_triangle(x_up, 1, {0, 0, 4}, {0, 0, 5}, {-2, -3, 4});
}

TEST(LoadMesh, WhatIsAskedForWinsOverWhatColladaSays) {
  for (const char* name : {"x_up.dae", "y_up.dae", "z_up.dae"}) {
    SCOPED_TRACE(name);
    const auto file = kDataFolder / name;
    expect_triangle(load_mesh(file, {.unit_m = 0.1, .up = UpAxis::Z}), 1, {40, 0, 0}, {50, 0, 0},
                    {40, 20, 30});
    expect_triangle(load_mesh(file, {.up = UpAxis::Y}), 1, {4, 0, 0}, {5, 0, 0}, {4, -3, 2});
  }
  expect_triangle(load_mesh(kDataFolder / "y_up.dae", {.unit_m = 1.0}), 0, {0, 0, 0}, {100, 0, 0},
                  {0, -300, 200});
}

TEST(LoadMesh, GltfIsYUpAndItsInstancesAppearOnceEach) {
  const TriangleMesh mesh = load_mesh(kDataFolder / "two_nodes.gltf");
  ASSERT_EQ(mesh.triangles.size(), 2U);
  expect_triangle(mesh, 0, {0, 0, 0}, {1, 0, 0}, {0, -3, 2});
  expect_triangle(mesh, 1, {4, 0, 0}, {5, 0, 0}, {4, -3, 2});
  expect_triangle(load_mesh(kDataFolder / "two_nodes.gltf", {.up = UpAxis::Z}), 1, {4, 0, 0},
                  {5, 0, 0}, {4, 2, 3});
}

TEST(LoadMesh, LeavesOutDuplicatesAndTrianglesOfNoArea) {
  const TriangleMesh tidy = load_mesh(kDataFolder / "room.obj");
  EXPECT_EQ(tidy.triangles.size(), 12U);
  EXPECT_EQ(tidy.vertices_m.size(), 8U);
  EXPECT_NEAR(tidy.area_m2(), 2.0 * (4 * 3 + 4 * 2 + 3 * 2), 1e-9);
  EXPECT_EQ(tidy.bounds_m().min(), Eigen::Vector3d(-2, -1, 0));
  EXPECT_EQ(tidy.bounds_m().max(), Eigen::Vector3d(2, 2, 2));
  // The quadrilaterals that come twice may be cut along the other diagonal the second time, so what
  // must hold is that no triangle is left twice and none without an area.
  const TriangleMesh untidy = load_mesh(kDataFolder / "untidy_room.obj");
  std::set<std::array<std::uint32_t, 3>> distinct;
  for (std::size_t i = 0; i < untidy.triangles.size(); ++i) {
    std::array<std::uint32_t, 3> corners = untidy.triangles[i];
    std::sort(corners.begin(), corners.end());
    EXPECT_TRUE(distinct.insert(corners).second) << i;
    const Eigen::Vector3d a = untidy.corner_m(i, 0);
    EXPECT_GT((untidy.corner_m(i, 1) - a).cross(untidy.corner_m(i, 2) - a).norm(), 0.1) << i;
  }
}

TEST(LoadMesh, RefusesWhatIsLongerThanFloatsReach) {
  const std::string why =
      message_of([] { load_mesh(kDataFolder / "triangle.ply", {.unit_m = 3000.0}); });
  EXPECT_NE(why.find("triangle.ply: is 9000 m long"), std::string::npos) << why;
  EXPECT_NE(why.find("--unit"), std::string::npos) << why;
}

TEST(LoadMesh, GivesUpAFileThatTakesForEver) {
  LoadLimits limits;
  limits.seconds = 1;
  const std::string why = message_of([&] { load_mesh(kDataFolder / "endless.ply", {}, limits); });
  EXPECT_NE(why.find("endless.ply: reading it took longer than 1 s"), std::string::npos) << why;
  EXPECT_NE(why.find("export it again"), std::string::npos) << why;
  EXPECT_NE(why.find("NEXTVIEW_CAD_SECONDS"), std::string::npos) << why;
  EXPECT_TRUE(no_child_is_left());
}

TEST(LoadMesh, GivesUpAFileThatFillsTheMemory) {
  LoadLimits limits;
  limits.memory_mb = 300;
  const std::string why =
      message_of([&] { load_mesh(kDataFolder / "huge_count.off", {}, limits); });
  EXPECT_NE(why.find("huge_count.off: reading it needed more than 300 MB"), std::string::npos)
      << why;
  EXPECT_NE(why.find("NEXTVIEW_CAD_MEMORY_MB"), std::string::npos) << why;
  EXPECT_TRUE(no_child_is_left());
}

TEST(LoadMesh, OutlivesAFileThatMakesAssimpAbort) {
  const std::string why = load_failure("abort.off");
  EXPECT_NE(why.find("abort.off: reading it crashed: the reader was killed by signal 6"),
            std::string::npos)
      << why;
  EXPECT_NE(why.find("convert it to another format"), std::string::npos) << why;
  EXPECT_TRUE(no_child_is_left());
}

TEST(LoadMesh, GivesUpWhenTheUserHasHadEnough) {
  LoadLimits limits;
  int asked = 0;
  limits.interrupted = [&asked] { return ++asked == 3; };
  const std::string why = message_of([&] { load_mesh(kDataFolder / "endless.ply", {}, limits); });
  EXPECT_NE(why.find("endless.ply: reading it was interrupted"), std::string::npos) << why;
  EXPECT_EQ(asked, 3);
  EXPECT_TRUE(no_child_is_left());
}

// What another process has read is what this one would have.
TEST(LoadMesh, IsReadCadFileInAProcessOfItsOwn) {
  int read = 0;
  for (const char* name : {"room.obj", "untidy_room.obj", "triangle.ply", "triangle.stl",
                           "two_nodes.gltf", "x_up.dae", "y_up.dae", "z_up.dae"}) {
    for (const SceneOptions& options :
         {SceneOptions{}, SceneOptions{.unit_m = 0.1 / 3.0, .up = UpAxis::X}}) {
      const TriangleMesh here = read_cad_file(kDataFolder / name, options);
      const TriangleMesh there = load_mesh(kDataFolder / name, options);
      EXPECT_EQ(there.vertices_m, here.vertices_m) << name;
      EXPECT_EQ(there.triangles, here.triangles) << name;
      ++read;
    }
  }
  EXPECT_EQ(read, 16);
}

TEST(LoadMesh, WorksInManyThreadsAtOnce) {
  const std::string digest = mesh_digest(load_mesh(kDataFolder / "room.obj"));
  std::atomic<int> same = 0;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back([&] {
        for (int k = 0; k < 5; ++k) {
          same += mesh_digest(load_mesh(kDataFolder / "room.obj")) == digest ? 1 : 0;
        }
      });
    }
  }
  EXPECT_EQ(same, 20);
  EXPECT_TRUE(no_child_is_left());
}

TEST(LoadLimits, AreThoseOfTheEnvironment) {
  const auto with = [](const char* seconds, const char* memory_mb) {
    ::setenv("NEXTVIEW_CAD_SECONDS", seconds, 1);
    ::setenv("NEXTVIEW_CAD_MEMORY_MB", memory_mb, 1);
  };
  EXPECT_EQ(load_limits().seconds, LoadLimits{}.seconds);
  with("7", "123");
  EXPECT_EQ(load_limits().seconds, 7);
  EXPECT_EQ(load_limits().memory_mb, 123);
  with("", "");
  EXPECT_EQ(load_limits().seconds, LoadLimits{}.seconds);
  EXPECT_EQ(load_limits().memory_mb, LoadLimits{}.memory_mb);
  for (const char* text : {"0", "-1", "1.5", "ten", "5s", "99999999999"}) {
    with(text, "");
    EXPECT_EQ(message_of([] { load_limits(); }), "NEXTVIEW_CAD_SECONDS is '" + std::string(text) +
                                                     "': must be a positive whole number");
    with("", text);
    EXPECT_EQ(message_of([] { load_limits(); }).find("NEXTVIEW_CAD_MEMORY_MB is '"), 0U);
  }
  ::unsetenv("NEXTVIEW_CAD_SECONDS");
  ::unsetenv("NEXTVIEW_CAD_MEMORY_MB");
}

TEST(MeshDigest, IsThatOfTheTrianglesAndFixed) {
  const TriangleMesh mesh = load_mesh(kDataFolder / "triangle.ply");
  EXPECT_EQ(mesh_digest(mesh), mesh_digest(load_mesh(kDataFolder / "triangle.stl")));
  EXPECT_EQ(mesh_digest(mesh), "2d6b36d9c7c1e43bf76c7be37fa22402");
  TriangleMesh moved = mesh;
  moved.vertices_m[2].z() = std::nextafter(3.0F, 4.0F);
  EXPECT_NE(mesh_digest(moved), mesh_digest(mesh));
  TriangleMesh turned = mesh;
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_NE(mesh_digest(turned), mesh_digest(mesh));
}

TEST(ParseUnit, KnowsLengthsAndRefusesTheRest) {
  EXPECT_EQ(parse_unit_m("m"), 1.0);
  EXPECT_EQ(parse_unit_m("cm"), 0.01);
  EXPECT_EQ(parse_unit_m("mm"), 0.001);
  EXPECT_EQ(parse_unit_m("in"), 0.0254);
  EXPECT_EQ(parse_unit_m("ft"), 0.3048);
  EXPECT_EQ(parse_unit_m("0.0042"), 0.0042);
  for (const char* text : {"", "0", "-1", "nan", "inf", "1 m", "parsec"}) {
    EXPECT_THROW(parse_unit_m(text), std::invalid_argument) << text;
  }
}

TEST(ParseUpAxis, KnowsThreeAxesAndRefusesTheRest) {
  EXPECT_EQ(parse_up_axis("x"), UpAxis::X);
  EXPECT_EQ(parse_up_axis("Y"), UpAxis::Y);
  EXPECT_EQ(parse_up_axis("z"), UpAxis::Z);
  for (const char* text : {"", "-z", "up"}) {
    EXPECT_THROW(parse_up_axis(text), std::invalid_argument) << text;
  }
}

}  // namespace
}  // namespace nextview
