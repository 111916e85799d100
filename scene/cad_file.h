#pragma once

#include <filesystem>

#include "scene/scene_options.h"
#include "scene/triangle_mesh.h"

namespace nextview {

/// Reads a CAD file with assimp, in this process: what load_mesh hands back. A file that is not
/// what it says it is may keep assimp busy for ever, exhaust the memory or abort the process, so
/// only nextview_cad_reader, which exists for that, calls it.
/// @throws SceneError as load_mesh
TriangleMesh read_cad_file(const std::filesystem::path& file, const SceneOptions& options);

}  // namespace nextview
