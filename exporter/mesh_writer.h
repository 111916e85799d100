#pragma once

#include <filesystem>

#include "exporter/surface_mesh.h"

namespace nextview {

/// Formats of meshes: binary PLY, Wavefront OBJ, glTF 2.0 in text (.gltf, with its numbers in a
/// .bin beside it) and in one file (.glb). Metres and z up, as the world frame; glTF is y up by its
/// specification: its (x, y, z) are the world's (x, z, -y).
enum class MeshFormat { Ply, Obj, Gltf, Glb };

/// @throws std::runtime_error naming the file when it cannot be written, or for a mesh without
///         triangles
void write_mesh(const SurfaceMesh& mesh, MeshFormat format, const std::filesystem::path& file);

}  // namespace nextview
