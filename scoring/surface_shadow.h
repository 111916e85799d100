#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <stop_token>
#include <vector>

#include "scene/triangle_mesh.h"
#include "scoring/box_pyramid.h"

namespace nextview {

/// Which triangles touch along which edges. Corners are the same where their coordinates are,
/// whatever their numbers; an edge may have any number of triangles.
class TriangleNeighbours {
 public:
  struct Neighbour {
    std::uint32_t triangle;
    std::uint32_t opposite;  ///< the vertex that is not on the edge
  };
  /// With stop requested it comes back incomplete, and is not to be asked.
  explicit TriangleNeighbours(const TriangleMesh& mesh, const std::stop_token& stop = {});

  const TriangleMesh& mesh() const { return *mesh_; }

  /// Calls visit(Neighbour) for every triangle on an edge (0: corners 0 and 1, 1: 1 and 2, 2: 2 and
  /// 0), the triangle itself among them, until one call says true.
  /// @return whether one did
  template <class Visit>
  bool any_at_edge(std::uint32_t triangle, std::size_t edge, const Visit& visit) const {
    const std::uint32_t run = run_of_edge_[3 * std::size_t{triangle} + edge];
    for (std::uint32_t i = run_start_[run]; i < run_start_[run + 1]; ++i) {
      if (visit(at_edges_[i])) return true;
    }
    return false;
  }

 private:
  const TriangleMesh* mesh_;
  std::vector<Neighbour> at_edges_;         ///< those of one edge in a row
  std::vector<std::uint32_t> run_start_;    ///< into at_edges_; one more than there are edges
  std::vector<std::uint32_t> run_of_edge_;  ///< by 3 triangle + edge
};

/// Answers whether the surface around a triangle hides a whole box from a point.
///
/// The shadow grows from the triangle over the edges it shares with others, as long as they are
/// seen from the point side by side and not one behind the other. All edges that the pyramid from
/// the point around the box meets have to be crossed:
///
///                        .-'|
///      point          .-'   |          The pyramid meets the edge between B and C: the shadow
///        *---------B--------|----.     grows from C to B. The edge between B and A it does not
///         `-.      |  box   |    |     meet, so A does not matter. Were there nothing beyond an
///            `-.   C--------|----'     edge in the pyramid, or a fold (a silhouette), something
///               `-.|        |          in the box might be seen past it.
///                  `-.      |
///
/// Where no edge is left to be crossed the shadow has no border inside the pyramid; so it covers
/// either none of its directions or all of them, and the first triangle does cover one.
class SurfaceShadow {
 public:
  /// The neighbours, and their mesh, must outlive the shadow.
  explicit SurfaceShadow(const TriangleNeighbours& neighbours);

  /// Whether the triangle lies in the direction from the point to the target.
  bool covers(std::uint32_t triangle, const Eigen::Vector3d& point_m,
              const Eigen::Vector3d& target_m) const;

  /// Whether the surface grown from the triangle hides the whole box from the point: true only when
  /// it does, false also when it is not clear. The triangle has to cover the direction to some
  /// target inside the box.
  bool hides(std::uint32_t triangle, const Eigen::Vector3d& point_m,
             const Eigen::Vector3d& target_m, const Eigen::AlignedBox3d& box);

 private:
  bool grow_over(std::uint32_t triangle, const BoxPyramid& pyramid);

  const TriangleNeighbours* neighbours_;
  std::vector<std::uint32_t> grown_in_;  ///< by triangle: the last call that reached it
  std::uint32_t call_ = 0;
  std::vector<std::uint32_t> grown_;  ///< the triangles of this call, in order
};

}  // namespace nextview
