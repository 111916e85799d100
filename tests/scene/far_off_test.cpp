// Models that lie far from their file's origin, on a map of the country, say.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>

#include "scene/mesh_file.h"
#include "tests/scene/scene_error.h"

namespace nextview {
namespace {

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

}  // namespace
}  // namespace nextview
