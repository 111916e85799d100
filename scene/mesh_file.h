#pragma once

#include <filesystem>
#include <functional>

#include "scene/scene_options.h"
#include "scene/triangle_mesh.h"

namespace nextview {

/// How much reading a CAD file may take.
struct LoadLimits {
  int seconds = 60;      ///< at least so long is waited, on a busy machine a little longer
  int memory_mb = 4096;  ///< resident, 10^6 bytes
  /// Asked every few milliseconds: whether the user has had enough.
  std::function<bool()> interrupted = {};
};

/// The limits of NEXTVIEW_CAD_SECONDS and NEXTVIEW_CAD_MEMORY_MB of the environment, which every
/// program of a run inherits, or else those above.
/// @throws SceneError when one of them is set to something else than a positive whole number
LoadLimits load_limits();

/// Loads the triangles of any file assimp reads, every node's transform applied, in a fixed order.
///
/// Coordinates are rounded to 0.01 mm, so that a room is the same to the last bit in every format
/// and unit. Points and lines, triangles of no area and exact duplicates (the same three corners in
/// any order of them) are left out. When a coordinate is beyond 8192 m, where floats no longer tell
/// millimetres apart, whole kilometres are taken from all of them in double (origin_in_file_m);
/// that can be had of OBJ, and of PLY with text or doubles. Y up becomes z up by the rotation (x,
/// y, z) -> (x, -z, y), x up by (x, y, z) -> (-y, -z, x), as COLLADA has it.
///
/// The file is read by a process of its own, nextview_cad_reader beside the running program, so
/// that whatever is in it neither stops nor ends this one.
/// @throws SceneError when there is no such file, assimp cannot read it, it has no triangles, a
/// coordinate is not finite or beyond 8192 m in a format of floats, the model is longer than that,
/// it takes more than the limits, the reader crashes over it, or the user has had enough
TriangleMesh load_mesh(const std::filesystem::path& file, const SceneOptions& options = {},
                       const LoadLimits& limits = load_limits());

}  // namespace nextview
