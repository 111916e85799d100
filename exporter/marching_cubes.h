#pragma once

#include <array>
#include <span>
#include <vector>

namespace nextview {

/// Marching Cubes (P14) over solid and free corners. The table of its 256 cases is derived here and
/// not typed: on every face of the cube the crossed edges are joined by one rule, which sees
/// nothing but the face, so that the surfaces of two cubes meet without a gap; the pieces close to
/// loops, and the loops are cut into triangles.
///
/// Corner c of a cube lies at (c & 1, c >> 1 & 1, c >> 2 & 1). An edge runs along its axis from a
/// corner whose bit of that axis is 0.
struct CubeEdge {
  int axis;    ///< 0..2
  int corner;  ///< where it starts
};
constexpr int kCubeEdges = 12;
CubeEdge cube_edge(int edge);

/// The triangles of a case, as edges of the cube, wound counter-clockwise seen from the free side.
/// Where a face has two solid corners across, they are joined: a surface one voxel thick has no
/// hole.
/// @param solid bit c: corner c is solid
std::span<const std::array<int, 3>> cube_triangles(unsigned solid);

}  // namespace nextview
