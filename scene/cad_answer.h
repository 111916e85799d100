#pragma once

#include <cstdio>
#include <optional>
#include <string>

#include "scene/triangle_mesh.h"

namespace nextview {

/// What nextview_cad_reader hands back through a file: the mesh, or why there is none.
/// @return whether all of it was written
bool write_answer(std::FILE* file, const TriangleMesh& mesh);
bool write_answer(std::FILE* file, const std::string& why_not);

/// An answer, of which one is there.
struct CadAnswer {
  std::optional<TriangleMesh> mesh;
  std::string why_not;
};

/// Reads a file that holds an answer from its beginning.
/// @return nothing when it holds no whole answer, or a mesh with a corner that is not there or not
///         finite: a reader that has gone astray may have written anything
std::optional<CadAnswer> take_answer(std::FILE* file);

}  // namespace nextview
