#include "exporter/mesh_writer.h"

#include <assimp/scene.h>

#include <assimp/Exporter.hpp>
#include <memory>
#include <stdexcept>

namespace nextview {
namespace {

/// assimp's name of a format.
const char* assimp_format(MeshFormat format) {
  switch (format) {
    case MeshFormat::Ply:
      return "plyb";
    case MeshFormat::Obj:
      return "objnomtl";
    case MeshFormat::Gltf:
      return "gltf2";
    case MeshFormat::Glb:
      return "glb2";
  }
  return "";
}

bool is_y_up(MeshFormat format) { return format == MeshFormat::Gltf || format == MeshFormat::Glb; }

std::unique_ptr<aiMesh> assimp_mesh(const SurfaceMesh& mesh, bool y_up) {
  auto result = std::make_unique<aiMesh>();
  result->mName = "recovered";
  result->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  result->mMaterialIndex = 0;
  result->mNumVertices = static_cast<unsigned>(mesh.vertices_m.size());
  result->mVertices = new aiVector3D[mesh.vertices_m.size()];
  for (std::size_t i = 0; i < mesh.vertices_m.size(); ++i) {
    const Eigen::Vector3f& v = mesh.vertices_m[i];
    result->mVertices[i] =
        y_up ? aiVector3D(v.x(), v.z(), -v.y()) : aiVector3D(v.x(), v.y(), v.z());
  }
  result->mNumFaces = static_cast<unsigned>(mesh.triangles.size());
  result->mFaces = new aiFace[mesh.triangles.size()];
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    aiFace& face = result->mFaces[i];
    face.mNumIndices = 3;
    face.mIndices = new unsigned[3];
    for (std::size_t k = 0; k < 3; ++k) face.mIndices[k] = mesh.triangles[i][k];
  }
  return result;
}

}  // namespace

void write_mesh(const SurfaceMesh& mesh, MeshFormat format, const std::filesystem::path& file) {
  if (mesh.triangles.empty()) {
    throw std::runtime_error(file.string() + ": there is no surface to write");
  }
  std::unique_ptr<aiMesh> of_assimp = assimp_mesh(mesh, is_y_up(format));
  auto material = std::make_unique<aiMaterial>();
  aiScene scene;  // owns what it points to, from where it does
  scene.mRootNode = new aiNode("recovered");
  scene.mRootNode->mNumMeshes = 1;
  scene.mRootNode->mMeshes = new unsigned[1]{0};
  scene.mMaterials = new aiMaterial* [1] { nullptr };
  scene.mMaterials[0] = material.release();
  scene.mNumMaterials = 1;
  scene.mMeshes = new aiMesh* [1] { nullptr };
  scene.mMeshes[0] = of_assimp.release();
  scene.mNumMeshes = 1;
  Assimp::Exporter exporter;
  if (exporter.Export(&scene, assimp_format(format), file.string()) != aiReturn_SUCCESS) {
    throw std::runtime_error(file.string() + ": cannot be written; does its folder exist? (" +
                             exporter.GetErrorString() + ")");
  }
}

}  // namespace nextview
