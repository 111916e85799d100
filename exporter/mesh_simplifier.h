#pragma once

#include <cstddef>
#include <optional>

#include "exporter/surface_mesh.h"

namespace nextview {

/// How far a mesh may be simplified. Whichever bound is met first ends it.
struct SimplifyOptions {
  std::optional<std::size_t> triangles;  ///< no fewer than about so many
  std::optional<double> error_m;         ///< no farther from the given surface than about so much
};

/// The mesh with fewer triangles, by meshoptimizer, which collapses edges in the order of their
/// quadric error and leaves ends of the surface ends. What it may leave behind is put right: two
/// triangles back to back are taken out, and one without area gives its longest side to the
/// neighbour. Where that does not help, less is simplified. So the result is as sound as the mesh
/// given: no edge is run along twice in one direction, no triangle is lower than 1 um, no vertex is
/// unused.
/// @throws std::invalid_argument unless the error is a length of 0 or more
SurfaceMesh simplified(const SurfaceMesh& mesh, const SimplifyOptions& options);

}  // namespace nextview
