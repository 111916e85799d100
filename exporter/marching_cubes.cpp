#include "exporter/marching_cubes.h"

#include <limits>
#include <map>
#include <utility>

namespace nextview {
namespace {

using Triangles = std::vector<std::array<int, 3>>;

// The edge between two corners that differ in one bit.
int edge_between(int a, int b) {
  const int axis = (a ^ b) == 1 ? 0 : (a ^ b) == 2 ? 1 : 2;
  const int low = a & b;
  // The two other bits of the corner it starts at.
  return 4 * axis + (low >> ((axis + 1) % 3) & 1) + 2 * (low >> ((axis + 2) % 3) & 1);
}

// The corners of a face, counter-clockwise seen from outside the cube.
std::array<int, 4> face_corners(int axis, int side) {
  const int u = 1 << (axis + 1) % 3;
  const int v = 1 << (axis + 2) % 3;
  const int base = side << axis;
  if (side == 1) return {base, base | u, base | u | v, base | v};
  return {base, base | v, base | u | v, base | u};
}

// For each crossed edge the one that follows it on the surface's way around the free side.
std::map<int, int> successors(unsigned solid) {
  std::map<int, int> next;
  const auto is_solid = [solid](int corner) { return (solid >> corner & 1U) != 0; };
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      const std::array<int, 4> corners = face_corners(axis, side);
      const auto corner = [&](int i) { return corners[static_cast<std::size_t>(i % 4)]; };
      for (int i = 0; i < 4; ++i) {
        if (!is_solid(corner(i)) || is_solid(corner(i + 1))) continue;
        // From solid to free; where does the same free stretch end?
        int j = i + 1;
        while (!is_solid(corner(j + 1))) ++j;
        next[edge_between(corner(j), corner(j + 1))] = edge_between(corner(i), corner(i + 1));
      }
    }
  }
  return next;
}

bool share_a_face(int edge_a, int edge_b) {
  const CubeEdge a = cube_edge(edge_a);
  const CubeEdge b = cube_edge(edge_b);
  for (int axis = 0; axis < 3; ++axis) {
    if (a.axis != axis && b.axis != axis && ((a.corner ^ b.corner) >> axis & 1) == 0) return true;
  }
  return false;
}

// Cuts the stretch [first, last] of a loop into triangles with as few cuts as possible in a face of
// the cube, where the neighbour might make the same cut.
int cut(const std::vector<int>& loop, std::size_t first, std::size_t last, Triangles& triangles) {
  if (last < first + 2) return 0;
  int fewest = std::numeric_limits<int>::max();
  Triangles best;
  const auto is_bad = [&](std::size_t a, std::size_t b) {
    return b > a + 1 && !(a == 0 && b + 1 == loop.size()) && share_a_face(loop[a], loop[b]) ? 1 : 0;
  };
  for (std::size_t apex = first + 1; apex < last; ++apex) {
    Triangles tried = {{loop[first], loop[apex], loop[last]}};
    const int bad = is_bad(first, apex) + is_bad(apex, last) + cut(loop, first, apex, tried) +
                    cut(loop, apex, last, tried);
    if (bad < fewest) {
      fewest = bad;
      best = tried;
    }
  }
  triangles.insert(triangles.end(), best.begin(), best.end());
  return fewest;
}

Triangles triangles_of(unsigned solid) {
  Triangles triangles;
  std::map<int, int> next = successors(solid);
  while (!next.empty()) {
    std::vector<int> loop;
    for (auto at = next.begin(); at != next.end(); at = next.find(loop.back())) {
      loop.push_back(at->second);
      next.erase(at);
    }
    cut(loop, 0, loop.size() - 1, triangles);
  }
  return triangles;
}

}  // namespace

CubeEdge cube_edge(int edge) {
  const int axis = edge / 4;
  const int low = (edge & 1) << (axis + 1) % 3;
  const int high = (edge >> 1 & 1) << (axis + 2) % 3;
  return {axis, low | high};
}

std::span<const std::array<int, 3>> cube_triangles(unsigned solid) {
  static const std::vector<Triangles> kCases = [] {
    std::vector<Triangles> cases;
    for (unsigned corners = 0; corners < 256; ++corners) cases.push_back(triangles_of(corners));
    return cases;
  }();
  return kCases[solid & 255U];
}

}  // namespace nextview
