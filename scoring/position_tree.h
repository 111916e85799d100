#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "scene/scene.h"
#include "scoring/surface_shadow.h"

namespace nextview {

/// The triangle that hides a surface point from a position, or nothing when it can be seen: the
/// definition of visibility, which the plain twin in the tests uses one pair at a time.
std::optional<std::uint32_t> hidden_by(const Scene& scene, const Eigen::Vector3d& point_m,
                                       const Eigen::Vector3d& position_m);

/// Answers exactly, and without looking at every position, whether a surface point can be seen from
/// any of many positions.
///
/// The positions are the leaves of a tree of boxes. A ray is cast to one position of a box. If a
/// triangle is in the way, and the shadow of the surface around it (see SurfaceShadow) holds the
/// whole box, all its positions are hidden:
///
///            point                  o  o  o    box: hidden
///              *------------/----   o  o  o
///                \         /        o  o  o
///                  \      / surface
///                    \   /            o  o    box: may be seen, so look at its halves
///
/// Neighbouring points are mostly hidden by the same triangles and seen from the same positions, so
/// those are tried first; this changes the time and never the answer.
class PositionTree {
 public:
  /// @param range_max_m positions farther away see nothing
  /// The scene must outlive the tree.
  /// @throws std::invalid_argument when there are no positions
  PositionTree(const Scene& scene, const TriangleNeighbours& neighbours,
               std::vector<Eigen::Vector3d> positions, double range_max_m);

  /// Whether some position sees the point. Not const: it remembers what hid the last points.
  bool sees(const Eigen::Vector3d& point_m);

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    std::int32_t representative = 0;  ///< the position nearest to the middle
    std::int32_t left = -1;           ///< -1 for a leaf
    std::int32_t right = -1;
    std::optional<std::uint32_t> last_shadow;  ///< triangle that last hid the whole box
  };
  /// What a ray to a position has met already, handed down so that it is cast once.
  struct Blocked {
    std::int32_t position;
    std::uint32_t triangle;
  };

  std::int32_t build(std::int32_t* begin, std::int32_t* end);
  bool node_sees(std::int32_t at, const Eigen::Vector3d& point_m, std::optional<Blocked> known);

  const Scene* scene_;
  std::vector<Eigen::Vector3d> positions_;
  double range_max_m_;
  SurfaceShadow shadow_;
  std::vector<Node> nodes_;
  std::int32_t root_;
  std::int32_t last_seen_from_ = 0;
};

}  // namespace nextview
