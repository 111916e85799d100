#include "scene/mesh_file.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <set>
#include <sstream>
#include <thread>
#include <vector>

#include "scene/cad_file.h"

#include "tests/scene/test_worlds.h"

namespace nextview {
namespace {

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const SceneError& error) {
    return error.what();
  }
  return "no SceneError";
}

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

/// Writes files that lie far off.
class FarOff : public testing::Test {
 protected:
  ~FarOff() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& bytes) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }

  /// A triangle at (east, north, up) with sides of 0.125 m and 0.25 m along the first two axes.
  std::filesystem::path write_obj(const std::string& east, const std::string& north) {
    return write("far.obj", "# " + east + "\nv " + east + ".5 " + north +
                                ".25 100.125 0.5 0.5 0.5\nv " + east + ".625 " + north +
                                ".25 100.125\nv  " + east + ".5 " + north +
                                ".5 100.125\r\nvn 0 0 1\nf 1//1 2//1 3//1\n");
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("nextview-far-off-" + std::to_string(::getpid()));
};

std::string ply_header(const std::string& format, const std::string& type, int vertices,
                       int faces = 1) {
  return "ply\nformat " + format + " 1.0\nelement vertex " + std::to_string(vertices) +
         "\nproperty uchar red\nproperty " + type + " x\nproperty " + type + " y\nproperty " +
         type + " z\nelement face " + std::to_string(faces) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

template <class Number>
void append_bytes(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

/// The triangle of write_obj.
template <class Coordinate>
std::string binary_ply(const std::string& type, double east, double north) {
  std::string bytes = ply_header("binary_little_endian", type, 3);
  for (const Eigen::Vector3d& vertex :
       {Eigen::Vector3d(0.5, 0.25, 100.125), Eigen::Vector3d(0.625, 0.25, 100.125),
        Eigen::Vector3d(0.5, 0.5, 100.125)}) {
    bytes += '\x7f';
    append_bytes(bytes, static_cast<Coordinate>(east + vertex.x()));
    append_bytes(bytes, static_cast<Coordinate>(north + vertex.y()));
    append_bytes(bytes, static_cast<Coordinate>(vertex.z()));
  }
  bytes += '\x03';
  for (const std::int32_t corner : {0, 1, 2}) append_bytes(bytes, corner);
  return bytes;
}

TEST_F(FarOff, IsMovedInDoubleByWholeKilometres) {
  const std::string text_ply =
      ply_header("ascii", "double", 3) +
      "7 500123.5 5400456.25 100.125\n7 500123.625 5400456.25 100.125\n7 500123.5 5400456.5 "
      "100.125\n3 0 1 2\n";
  for (const std::filesystem::path& file :
       {write_obj("500123", "5400456"), write("text.ply", text_ply),
        write("doubles.ply", binary_ply<double>("double", 500123, 5400456))}) {
    SCOPED_TRACE(file);
    const TriangleMesh mesh = load_mesh(file);
    EXPECT_EQ(mesh.origin_in_file_m, Eigen::Vector3d(500e3, 5400e3, 0.0));
    ASSERT_EQ(mesh.triangles.size(), 1U);
    EXPECT_EQ(mesh.corner_m(0, 0), Eigen::Vector3d(123.5, 456.25, 100.125));
    EXPECT_EQ(mesh.corner_m(0, 1), Eigen::Vector3d(123.625, 456.25, 100.125));
    EXPECT_EQ(mesh.corner_m(0, 2), Eigen::Vector3d(123.5, 456.5, 100.125));
  }
}

TEST_F(FarOff, IsMovedAfterUnitAndAxis) {
  const std::filesystem::path file = write_obj("-12000000", "900000");
  // Centimetres: (-120000, 9000, 1) m. X up is (x, y, z) -> (-y, -z, x).
  const TriangleMesh mesh = load_mesh(file, {.unit_m = 0.01, .up = UpAxis::X});
  EXPECT_EQ(mesh.origin_in_file_m, Eigen::Vector3d(-10e3, 0.0, -121e3));
  ASSERT_EQ(mesh.triangles.size(), 1U);
  EXPECT_LT((mesh.corner_m(0, 0) - Eigen::Vector3d(999.9975, -1.00125, 1000.005 - 0.01)).norm(),
            1e-4)
      << mesh.corner_m(0, 0);
}

TEST_F(FarOff, IsWhatTheSameModelIsNearBy) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> within(0.0, 900.0);
  constexpr int kVertices = 3000;
  std::ostringstream near_obj;
  std::ostringstream far_obj;
  std::ostringstream far_ply;
  for (std::ostringstream* text : {&near_obj, &far_obj, &far_ply}) text->precision(17);
  far_ply << ply_header("ascii", "float", kVertices, kVertices / 3);
  for (int i = 0; i < kVertices; ++i) {
    near_obj << 'v';
    far_obj << 'v';
    far_ply << '9';
    for (const double origin : {500e3, 5400e3, -9e3}) {
      const double far = origin + within(random);
      near_obj << ' ' << far - origin;
      far_obj << ' ' << far;
      far_ply << ' ' << far;
    }
    near_obj << '\n';
    far_obj << '\n';
    far_ply << '\n';
  }
  for (int i = 0; i < kVertices; i += 3) {
    near_obj << "f " << i + 1 << ' ' << i + 2 << ' ' << i + 3 << '\n';
    far_obj << "f " << i + 1 << ' ' << i + 2 << ' ' << i + 3 << '\n';
    far_ply << "3 " << i << ' ' << i + 1 << ' ' << i + 2 << '\n';
  }
  const TriangleMesh near_by = load_mesh(write("near.obj", near_obj.str()));
  EXPECT_EQ(near_by.triangles.size(), kVertices / 3U);
  EXPECT_TRUE(near_by.origin_in_file_m.isZero(0.0));
  const std::string digest = mesh_digest(near_by);
  EXPECT_EQ(mesh_digest(load_mesh(write("far.obj", far_obj.str()))), digest);
  EXPECT_EQ(mesh_digest(load_mesh(write("far.ply", far_ply.str()))), digest);
}

TEST_F(FarOff, IsRefusedWhereOnlyFloatsAreToBeHad) {
  const std::string stl =
      "solid far\nfacet normal 0 0 1\nouter loop\nvertex 500123.5 0 0\nvertex "
      "500124.5 0 0\nvertex 500123.5 1 0\nendloop\nendfacet\nendsolid far\n";
  for (const std::filesystem::path& file :
       {write("far.stl", stl), write("floats.ply", binary_ply<float>("float", 500123, 5400456))}) {
    const std::string why = message_of([&] { load_mesh(file); });
    EXPECT_NE(why.find(file.string() + ": a vertex lies "), std::string::npos) << why;
    EXPECT_NE(why.find("export it as OBJ or PLY"), std::string::npos) << why;
    EXPECT_NE(why.find("--unit"), std::string::npos) << why;
  }
}

TEST_F(FarOff, IsLeftWhereItIsAsFarAsFloatsReach) {
  const std::filesystem::path file =
      write("far.obj", "v 8192 0 0\nv 8192 1 0\nv 8192 0 1\nf 1 2 3\n");
  EXPECT_TRUE(load_mesh(file).origin_in_file_m.isZero(0.0));
  EXPECT_EQ(load_mesh(file, {.unit_m = 1.125}).origin_in_file_m, Eigen::Vector3d(9000.0, 0, 0));
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
