#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "scene/scene.h"
#include "scoring/box_pyramid.h"
#include "scoring/surface_shadow.h"

namespace nextview {

/// Where normal . (x - point) >= offset: a normal of the world frame and metres.
struct HalfSpace {
  Eigen::Vector3d normal;
  double offset_m;
};
/// A convex piece of space as seen from some point: what lies in all of the half spaces.
struct SpacePiece {
  static constexpr std::size_t kMost = 17;
  Eigen::AlignedBox3d box;  ///< that holds all of it, world frame
  std::array<HalfSpace, kMost> half_spaces;
  std::size_t size = 0;

  void add(const Eigen::Vector3d& normal, double offset_m) {
    half_spaces[size++] = {normal, offset_m};
  }
};

/// Answers whether many triangles together, touching or not, hide a box from a point.
///
/// What the point sees of the box is a polygon on a plane before it. From the polygon the shadows
/// of triangles are cut, one after the other, until nothing is left of it; each is that of what a
/// ray into the middle of a remaining piece meets first.
///
///      +-----------+      +-----+  .--+            .--+
///      |           |      |      \ |  |            |  |
///      |  polygon  |  ->  |       \|  |  ->        |  |  ->  nothing, so hidden
///      |           |      +--------+  |            |  |
///      +-----------+         +--------+            +--+
///
/// An edge counts exactly where the surface goes on beyond it in a triangle that is cut out too: no
/// ray slips through there. All other edges count kShadowMargin further inside the shadow, so that
/// casting a ray in float would say the same. Where surfaces meet without sharing an edge this
/// leaves a narrow strip. And a triangle does not hide what lies before it. Such pieces of space
/// are handed back, so that rays are cast to what lies in them.
class ShadowUnion {
 public:
  /// The scene and the neighbours of its triangles must outlive this.
  ShadowUnion(const Scene& scene, const TriangleNeighbours& neighbours);

  /// Whether triangles hide from the point all of the box that lies outside some pieces of space:
  /// true only when they do, false also when it is not clear.
  /// @param triangles those to try first; with true those that were needed
  /// @param open with true: where it is not known that everything is hidden
  bool hides(const Eigen::Vector3d& point_m, const Eigen::AlignedBox3d& box,
             std::vector<std::uint32_t>& triangles, std::vector<SpacePiece>& open);

 private:
  struct Polygon {
    static constexpr std::size_t kMostCorners = 16;
    std::array<Eigen::Vector2d, kMostCorners> corners;
    std::size_t size = 0;
  };
  /// Inside where normal . (x, y, 1) >= offset.
  struct Side {
    Eigen::Vector3d normal;
    double offset;

    double depth(const Eigen::Vector2d& at) const {
      return normal.x() * at.x() + normal.y() * at.y() + normal.z() - offset;
    }
  };
  /// A triangle as seen from the point.
  struct Shadow {
    std::uint32_t triangle = 0;
    std::array<Side, 3> sides;
    std::array<bool, 3> goes_on = {};  ///< counts exactly at the edge, as some triangle lies beyond
    bool before_box = false;
    BoxPyramid::Plane plane;
  };

  bool cut_all(const BoxPyramid& pyramid);
  std::optional<Shadow> shadow_of(std::uint32_t triangle, const BoxPyramid& pyramid) const;
  bool cut(const Shadow& shadow);
  static bool beside(const Polygon& polygon, const Shadow& shadow);
  bool goes_on_in_used(const Shadow& shadow, std::size_t edge, const BoxPyramid& pyramid) const;
  bool pull_back_open_edges(const BoxPyramid& pyramid);
  void add_strips_at_open_edges(const BoxPyramid& pyramid);
  static void add_sides(const Polygon& polygon, const BoxPyramid& pyramid, SpacePiece& piece);
  static SpacePiece piece_before(const Polygon& polygon, const BoxPyramid::Plane& plane,
                                 const BoxPyramid& pyramid);
  static bool split(const Polygon& polygon, const Side& side, Polygon& inside, Polygon& outside);
  static Polygon whole(const BoxPyramid& pyramid);

  const Scene* scene_;
  const TriangleNeighbours* neighbours_;
  std::vector<std::uint32_t> used_in_;  ///< by triangle: the last call that cut it out
  std::uint32_t call_ = 0;
  std::vector<Shadow> used_;
  std::vector<Polygon> pieces_;  ///< what is left
  std::vector<Polygon> strips_;
  /// What was cut out by triangles that are not wholly before the box, and their planes.
  std::vector<std::pair<Polygon, BoxPyramid::Plane>> in_front_;
  bool too_many_corners_ = false;
};

}  // namespace nextview
