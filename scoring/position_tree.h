#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <unordered_map>
#include <vector>

#include "scene/scene.h"
#include "scoring/shadow_union.h"
#include "scoring/surface_shadow.h"

namespace nextview {

/// The triangle that hides a surface point from a position, or nothing when it can be seen: the
/// definition of visibility, which the plain twin in the tests uses one pair at a time.
std::optional<std::uint32_t> hidden_by(const Scene& scene, const Eigen::Vector3d& point_m,
                                       const Eigen::Vector3d& position_m);

/// Whether a triangle hides a position from a point by more than the rounding of a ray: true only
/// where hidden_by would name a triangle, maybe another one; false also when it is not clear. Costs
/// a fraction of a ray.
bool clearly_hides(const TriangleMesh& mesh, std::uint32_t triangle, const Eigen::Vector3d& point_m,
                   const Eigen::Vector3d& position_m);

/// Positions as a tree of boxes, for any number of searches at once.
class PositionTree {
 public:
  struct Node {
    Eigen::AlignedBox3d box;
    std::int32_t begin = 0;  ///< positions [begin, end)
    std::int32_t end = 0;
    std::int32_t middle = 0;  ///< the position nearest to the middle of the box
    std::int32_t left = -1;   ///< -1 for a leaf
    std::int32_t right = -1;

    std::int32_t size() const { return end - begin; }
  };

  /// With stop requested it comes back incomplete, and is not to be searched.
  /// @throws std::invalid_argument when there are no positions
  explicit PositionTree(std::vector<Eigen::Vector3d> positions, const std::stop_token& stop = {});

  const Node& node(std::int32_t i) const { return nodes_[static_cast<std::size_t>(i)]; }
  std::int32_t root() const { return static_cast<std::int32_t>(nodes_.size()) - 1; }
  const Eigen::Vector3d& position_m(std::int32_t i) const {
    return positions_[static_cast<std::size_t>(i)];
  }
  std::size_t size() const { return positions_.size(); }

 private:
  std::int32_t build(std::int32_t begin, std::int32_t end, const std::stop_token& stop);

  std::vector<Eigen::Vector3d> positions_;  ///< those of a node in a row
  std::vector<Node> nodes_;                 ///< children before their parents
};

/// Answers exactly, and without looking at every position, whether a surface point can be seen from
/// any of them.
///
/// A ray is cast to one position of a box. If a triangle is in the way, and the shadow of the
/// surface around it (SurfaceShadow), or that of many triangles together (ShadowUnion), holds the
/// whole box, all its positions are hidden:
///
///            point                  o  o  o    box: hidden
///              *------------/----   o  o  o
///                \         /        o  o  o
///                  \      / surface
///                    \   /            o  o    box: may be seen, so look at its halves
///
/// Neighbouring points are mostly hidden by the same triangles and seen from the same positions, so
/// those are tried first, down to the triangle that hid a position last; this changes the time and
/// never the answer. One search a thread.
class PositionSearch {
 public:
  /// @param range_max_m positions farther away see nothing
  /// Scene, neighbours and tree must outlive the search.
  PositionSearch(const Scene& scene, const TriangleNeighbours& neighbours, const PositionTree& tree,
                 double range_max_m);

  /// Whether some position sees the point.
  bool sees(const Eigen::Vector3d& point_m);

 private:
  /// The union that hid all of a node from the last point for which one did.
  struct UnionMemory {
    std::vector<std::uint32_t> triangles;
    std::uint8_t skip = 0;     ///< points for which a union is not tried
    std::uint8_t unclear = 0;  ///< of the unions tried last, those that were not clear in a row
  };
  /// What a ray to a position has met already, handed down so that it is cast once.
  struct Blocked {
    std::int32_t position;
    std::uint32_t triangle;
  };

  std::optional<std::uint32_t> hider_of(std::int32_t position);
  bool position_sees(std::int32_t position);
  bool node_sees(std::int32_t at, std::optional<Blocked> known);
  std::optional<bool> union_sees(std::int32_t at);
  bool sees_in_piece(std::int32_t at, SpacePiece& piece);

  const Scene* scene_;
  const PositionTree* tree_;
  double range_max_m_;
  SurfaceShadow surface_;
  ShadowUnion union_;
  // What hid something from the last point for which it did.
  std::vector<std::uint32_t> hider_;       ///< by position: a triangle, or kNone
  std::vector<std::uint32_t> node_hider_;  ///< by node: a triangle of the surface, or kNone
  std::unordered_map<std::int32_t, UnionMemory> unions_;  ///< by node, if large; looked up only
  std::int32_t last_seen_from_ = 0;
  std::vector<SpacePiece> open_;
  int casts_left_ = 0;
  Eigen::Vector3d point_m_ = Eigen::Vector3d::Zero();  ///< that is looked at
};

}  // namespace nextview
