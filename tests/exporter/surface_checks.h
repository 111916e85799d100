#pragma once

#include <map>
#include <utility>

#include "exporter/surface_mesh.h"

namespace nextview {

/// What a mesh must not have, counted without the help of what made it.
struct SurfaceFaults {
  int edges_run_twice = 0;  ///< in the same direction: neighbours wound against each other, or a
                            ///< third triangle at an edge
  int low_triangles = 0;    ///< lower than asked for
  int unused_vertices = 0;
};

/// How often each edge is run along, by the vertices it goes from and to.
using DirectedEdges = std::map<std::pair<std::uint32_t, std::uint32_t>, int>;

inline DirectedEdges directed_edges(const SurfaceMesh& mesh) {
  DirectedEdges edges;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++edges[{triangle[k], triangle[(k + 1) % 3]}];
  }
  return edges;
}

inline SurfaceFaults faults_of(const SurfaceMesh& mesh, double least_height) {
  SurfaceFaults faults;
  for (const auto& [edge, times] : directed_edges(mesh)) faults.edges_run_twice += times > 1;
  std::vector<bool> used(mesh.vertices_m.size(), false);
  for (const auto& triangle : mesh.triangles) {
    faults.low_triangles += !(least_height_m(mesh, triangle) >= least_height);
    for (const std::uint32_t vertex : triangle) used[vertex] = true;
  }
  for (const bool is_used : used) faults.unused_vertices += !is_used;
  return faults;
}

/// Edges at which the surface ends.
inline std::vector<std::pair<std::uint32_t, std::uint32_t>> open_edges(const SurfaceMesh& mesh) {
  const DirectedEdges edges = directed_edges(mesh);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> open;
  for (const auto& [edge, times] : edges) {
    if (!edges.contains({edge.second, edge.first})) open.push_back(edge);
  }
  return open;
}

}  // namespace nextview
