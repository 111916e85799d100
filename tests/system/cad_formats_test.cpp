// CAD from the wild: the same room in a dozen formats, units, axes and states of disorder gives the
// same run, to the last bit of the map.

#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <assimp/Exporter.hpp>
#include <fstream>
#include <functional>
#include <memory>

#include "scene/mesh_file.h"
#include "tests/system/program.h"

namespace nextview {
namespace {

constexpr int kViews = 4;
constexpr double kInch_m = 0.0254;

/// The world's z up in a format's own axes.
enum class Axes { ZUp, YUp };

Eigen::Matrix4d file_from_world(Axes axes, double unit_m = 1.0) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  if (axes == Axes::YUp) matrix.topLeftCorner<3, 3>() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  matrix.topLeftCorner<3, 3>() /= unit_m;
  return matrix;
}

TriangleMesh room() { return load_mesh(NEXTVIEW_SOURCE_DIR "/scenes/boxes/boxes.obj"); }

aiMatrix4x4 to_assimp(const Eigen::Matrix4d& m) {
  aiMatrix4x4 matrix;
  for (unsigned int i = 0; i < 4; ++i) {
    for (unsigned int j = 0; j < 4; ++j) matrix[i][j] = static_cast<ai_real>(m(i, j));
  }
  return matrix;
}

aiMesh* to_assimp(const TriangleMesh& mesh, const Eigen::Matrix4d& file_from_world) {
  auto* out = new aiMesh;  // of the scene, which deletes it
  out->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  out->mNumVertices = static_cast<unsigned int>(mesh.vertices_m.size());
  out->mVertices = new aiVector3D[mesh.vertices_m.size()];
  out->mNormals = new aiVector3D[mesh.vertices_m.size()];  // some formats are not written without
  for (std::size_t i = 0; i < mesh.vertices_m.size(); ++i) {
    const Eigen::Vector4d v = file_from_world * mesh.vertices_m[i].cast<double>().homogeneous();
    out->mVertices[i] = {static_cast<ai_real>(v.x()), static_cast<ai_real>(v.y()),
                         static_cast<ai_real>(v.z())};
    out->mNormals[i] = {0, 0, 1};
  }
  out->mNumFaces = static_cast<unsigned int>(mesh.triangles.size());
  out->mFaces = new aiFace[mesh.triangles.size()];
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& corners = mesh.triangles[i];
    out->mFaces[i].mNumIndices = 3;
    out->mFaces[i].mIndices = new unsigned int[3]{corners[0], corners[1], corners[2]};
  }
  return out;
}

/// A chain of nodes, each within the one before, the room in the last.
std::unique_ptr<aiScene> scene_of(const TriangleMesh& mesh, const Eigen::Matrix4d& file_from_mesh,
                                  const std::vector<Eigen::Matrix4d>& nodes) {
  auto scene = std::make_unique<aiScene>();
  scene->mNumMaterials = 1;
  scene->mMaterials = new aiMaterial* [1] { new aiMaterial };
  scene->mNumMeshes = 1;
  scene->mMeshes = new aiMesh* [1] { to_assimp(mesh, file_from_mesh) };
  scene->mMeshes[0]->mName = "room";
  scene->mRootNode = new aiNode("root");
  aiNode* node = scene->mRootNode;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    auto* child = new aiNode("node" + std::to_string(i));
    child->mTransformation = to_assimp(nodes[i]);
    node->addChildren(1, &child);
    node = child;
  }
  node->mNumMeshes = 1;
  node->mMeshes = new unsigned int[1]{0};
  return scene;
}

void write(const std::filesystem::path& file, const std::string& format, const TriangleMesh& mesh,
           const Eigen::Matrix4d& file_from_mesh, const std::vector<Eigen::Matrix4d>& nodes = {}) {
  Assimp::Exporter exporter;
  const auto scene = scene_of(mesh, file_from_mesh, nodes);
  ASSERT_EQ(exporter.Export(scene.get(), format, file.string()), aiReturn_SUCCESS)
      << format << ": " << exporter.GetErrorString();
}

/// assimp reads it and does not write it.
void write_off(const std::filesystem::path& file, const TriangleMesh& mesh) {
  std::ofstream out(file);
  out.precision(9);
  out << "OFF\n" << mesh.vertices_m.size() << " " << mesh.triangles.size() << " 0\n";
  for (const auto& v : mesh.vertices_m) out << v.x() << " " << v.y() << " " << v.z() << "\n";
  for (const auto& t : mesh.triangles) out << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
}

class CadFormats : public testing::Test {
 protected:
  /// The digests of the views of a run in a file's room.
  std::vector<std::string> digests_in(const std::filesystem::path& file,
                                      std::vector<std::string> more = {}) {
    const auto out = folder_ / ("run-" + std::to_string(runs_++));
    more.insert(more.begin(), {file.string(), "--start", "0.7", "1.0", "1.2", "--start-pan", "-90",
                               "--no-coverage"});
    const Outcome outcome = run_views(out, kViews, more);
    EXPECT_EQ(outcome.status, 0) << file << "\n" << outcome.output;
    return outcome.status == 0 ? column_of_views(out, "map_digest") : std::vector<std::string>();
  }
  void expect_same_run(const std::filesystem::path& file,
                       const std::vector<std::string>& more = {}) {
    if (of_obj_.empty()) {
      of_obj_ = digests_in(NEXTVIEW_SOURCE_DIR "/scenes/boxes/boxes.obj");
      ASSERT_EQ(of_obj_.size(), static_cast<std::size_t>(kViews));
    }
    EXPECT_EQ(digests_in(file, more), of_obj_) << file;
  }

  const TriangleMesh room_ = room();
  const TemporaryFolder folder_;

 private:
  std::vector<std::string> of_obj_;
  int runs_ = 0;
};

TEST_F(CadFormats, GiveTheSameRun) {
  struct Format {
    std::string file;
    std::string exporter;
    Axes axes = Axes::ZUp;
  };
  const std::vector<Format> formats = {{"text.ply", "ply"},
                                       {"binary.ply", "plyb"},
                                       {"text.stl", "stl"},
                                       {"binary.stl", "stlb"},
                                       {"room.3ds", "3ds"},
                                       {"room.fbx", "fbxa"},
                                       {"room.x3d", "x3d"},
                                       {"room.obj", "objnomtl"},
                                       {"room.gltf", "gltf2", Axes::YUp},
                                       {"room.glb", "glb2", Axes::YUp},
                                       {"room.dae", "collada", Axes::YUp},
                                       {"room.x", "x"}};
  for (const Format& format : formats) {
    SCOPED_TRACE(format.file);
    write(folder_ / format.file, format.exporter, room_, file_from_world(format.axes));
    expect_same_run(folder_ / format.file);
  }
  write_off(folder_ / "room.off", room_);
  expect_same_run(folder_ / "room.off");
}

TEST_F(CadFormats, InCentimetresAndInches) {
  write(folder_ / "cm.stl", "stlb", room_, file_from_world(Axes::ZUp, 0.01));
  expect_same_run(folder_ / "cm.stl", {"--unit", "cm"});
  write(folder_ / "inches.ply", "plyb", room_, file_from_world(Axes::ZUp, kInch_m));
  expect_same_run(folder_ / "inches.ply", {"--unit", "in"});
}

TEST_F(CadFormats, WithYUp) {
  write(folder_ / "y_up.obj", "objnomtl", room_, file_from_world(Axes::YUp));
  expect_same_run(folder_ / "y_up.obj", {"--up", "y"});
  // assimp turns this format by itself, from the z up it ought to have.
  write(folder_ / "y_up.3ds", "3ds", room_, file_from_world(Axes::YUp));
  expect_same_run(folder_ / "y_up.3ds", {"--up", "y"});
  write(folder_ / "cm_y_up.ply", "ply", room_, file_from_world(Axes::YUp, 0.01));
  expect_same_run(folder_ / "cm_y_up.ply", {"--up", "y", "--unit", "cm"});
}

TEST_F(CadFormats, WithWindingThatFlips) {
  TriangleMesh flipped = room_;
  for (std::size_t i = 0; i < flipped.triangles.size(); i += 3) {
    std::swap(flipped.triangles[i][1], flipped.triangles[i][2]);
  }
  write(folder_ / "flipped.ply", "ply", flipped, file_from_world(Axes::ZUp));
  expect_same_run(folder_ / "flipped.ply");
}

TEST_F(CadFormats, WithFacesTwice) {
  TriangleMesh twice = room_;
  for (std::size_t i = 0; i < room_.triangles.size(); i += 2) {
    const auto& triangle = room_.triangles[i];
    twice.triangles.push_back(triangle);
    twice.triangles.push_back({triangle[2], triangle[1], triangle[0]});
  }
  write(folder_ / "twice.ply", "ply", twice, file_from_world(Axes::ZUp));
  expect_same_run(folder_ / "twice.ply");
}

TEST_F(CadFormats, WithNodesWithinNodes) {
  // Moved, turned and made larger, one within the other: what the room needs is undone in it.
  Eigen::Matrix4d moved = Eigen::Matrix4d::Identity();
  moved.topRightCorner<3, 1>() << 12.5, -3.25, 0.7;
  Eigen::Matrix4d turned = Eigen::Matrix4d::Identity();
  turned.topLeftCorner<3, 3>() =
      Eigen::AngleAxisd(0.6, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  Eigen::Matrix4d larger = Eigen::Matrix4d::Identity();
  larger.diagonal() << 2.5, 2.5, 2.5, 1.0;
  const std::vector<Eigen::Matrix4d> nodes = {moved, turned, larger};
  const Eigen::Matrix4d undone = (moved * turned * larger).inverse() * file_from_world(Axes::YUp);
  for (const auto& [file, format] :
       {std::pair("nested.gltf", "gltf2"), std::pair("nested.glb", "glb2"),
        std::pair("nested.dae", "collada")}) {
    SCOPED_TRACE(file);
    write(folder_ / file, format, room_, undone, nodes);
    expect_same_run(folder_ / file);
  }
}

}  // namespace
}  // namespace nextview
