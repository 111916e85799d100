#include "scoring/shadow_union.h"

#include <algorithm>
#include <cmath>

namespace nextview {
namespace {

/// A union that takes more is cheaper shown in parts, for smaller boxes.
constexpr std::size_t kMostUsed = 64;
constexpr std::size_t kMostPieces = 64;
constexpr std::size_t kMostStrips = 16;

/// Wider pyramids are not looked at: on a plane before the point their polygon is too distorted.
constexpr double kWidestSlope = 3.0;
/// kShadowMargin on that plane: (x, y, 1) is no longer than 4.4 in such a pyramid.
constexpr double kPlaneMargin = 4.4 * kShadowMargin;
/// Thinner pieces are nothing: what is beside them is hidden up to well beyond them.
constexpr double kNothing = 0.01 * kShadowMargin;

}  // namespace

ShadowUnion::ShadowUnion(const Scene& scene, const TriangleNeighbours& neighbours)
    : scene_(&scene), neighbours_(&neighbours), used_in_(neighbours.mesh().triangles.size(), 0) {}

bool ShadowUnion::hides(const Eigen::Vector3d& point_m, const Eigen::AlignedBox3d& box,
                        std::vector<std::uint32_t>& triangles, std::vector<SpacePiece>& open) {
  const BoxPyramid pyramid(point_m, box);
  if (!pyramid.exists() || pyramid.least_slope().minCoeff() < -kWidestSlope ||
      pyramid.most_slope().maxCoeff() > kWidestSlope) {
    return false;
  }
  ++call_;
  used_.clear();
  strips_.clear();
  in_front_.clear();
  too_many_corners_ = false;
  pieces_.assign(1, whole(pyramid));
  for (const std::uint32_t triangle : triangles) {
    if (pieces_.empty()) break;
    if (const auto shadow = shadow_of(triangle, pyramid)) cut(*shadow);
  }
  if (!cut_all(pyramid)) return false;
  if (pull_back_open_edges(pyramid) && !cut_all(pyramid)) return false;
  add_strips_at_open_edges(pyramid);
  if (too_many_corners_ || strips_.size() > kMostStrips) return false;

  triangles.clear();
  open.clear();
  for (const Shadow& shadow : used_) triangles.push_back(shadow.triangle);
  for (const Polygon& strip : strips_) {
    open.emplace_back().box = box;
    add_sides(strip, pyramid, open.back());
  }
  for (const auto& [polygon, plane] : in_front_) {
    const SpacePiece piece = piece_before(polygon, plane, pyramid);
    if (piece.box.intersects(box)) open.push_back(piece);
  }
  return true;
}

/// Limits a piece to the directions of a polygon.
void ShadowUnion::add_sides(const Polygon& polygon, const BoxPyramid& pyramid, SpacePiece& piece) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < polygon.size; ++i) middle += polygon.corners[i].homogeneous();
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const Eigen::Vector3d normal = polygon.corners[i].homogeneous().cross(
        polygon.corners[(i + 1) % polygon.size].homogeneous());
    if (normal.norm() < kNothing) continue;  // two corners are one
    const double side = normal.dot(middle) < 0.0 ? -1.0 : 1.0;
    piece.add(side * (pyramid.frame() * normal.normalized()), 0.0);
  }
}

/// What lies in the directions of a polygon, before a plane.
SpacePiece ShadowUnion::piece_before(const Polygon& polygon, const BoxPyramid::Plane& plane,
                                     const BoxPyramid& pyramid) {
  SpacePiece piece;
  piece.box.extend(pyramid.point());
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const Eigen::Vector3d direction = pyramid.frame() * polygon.corners[i].homogeneous();
    // Not much less than 0, as a triangle of the plane lies there; far is as good as infinite.
    const double approach = std::max(1e-6, plane.normal.dot(direction));
    piece.box.extend(pyramid.point() + plane.offset / approach * direction);
  }
  const Eigen::Vector3d margin =
      Eigen::Vector3d::Constant(kShadowMargin) + 2.0 * kShadowMargin * piece.box.sizes();
  piece.box.min() -= margin;
  piece.box.max() += margin;
  piece.add(-plane.normal, -plane.offset);
  add_sides(polygon, pyramid, piece);
  return piece;
}

/// Cuts shadows out until nothing is left but strips.
bool ShadowUnion::cut_all(const BoxPyramid& pyramid) {
  while (!pieces_.empty()) {
    if (too_many_corners_ || pieces_.size() > kMostPieces || used_.size() >= kMostUsed ||
        strips_.size() > kMostStrips) {
      return false;
    }
    const Polygon piece = pieces_.back();
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < piece.size; ++i) middle += piece.corners[i];
    middle /= static_cast<double>(piece.size);
    const Eigen::Vector3d direction = (pyramid.frame() * middle.homogeneous()).normalized();
    const auto hit = scene_->first_hit(pyramid.point() + kLineOfSightGap_m * direction, direction);
    if (!hit) return false;
    if (used_in_[hit->triangle] != call_) {
      const auto shadow = shadow_of(hit->triangle, pyramid);
      if (!shadow) return false;
      if (cut(*shadow)) continue;
    }
    // What hides the middle of the piece does so only by less than the margin.
    strips_.push_back(piece);
    pieces_.pop_back();
  }
  return true;
}

/// Nothing when it hides nothing of the box or is not wholly between.
std::optional<ShadowUnion::Shadow> ShadowUnion::shadow_of(std::uint32_t triangle,
                                                          const BoxPyramid& pyramid) const {
  const TriangleMesh& mesh = neighbours_->mesh();
  const auto corners = pyramid.corners(mesh, triangle);
  if ((corners[0].outside & corners[1].outside & corners[2].outside) != 0) return std::nullopt;
  if (!pyramid.is_after_start(corners)) return std::nullopt;
  Shadow shadow;
  shadow.triangle = triangle;
  shadow.before_box = pyramid.is_before_box(corners);
  shadow.plane = BoxPyramid::plane_of(corners);
  for (std::size_t edge = 0; edge < 3; ++edge) {
    const Eigen::Vector3d& from = corners[edge].at;
    const Eigen::Vector3d& to = corners[(edge + 1) % 3].at;
    const Eigen::Vector3d& opposite = corners[(edge + 2) % 3].at;
    Eigen::Vector3d normal = from.cross(to);
    const double length = normal.norm();
    if (length < kShadowMargin * from.norm() * to.norm()) return std::nullopt;  // seen end-on
    normal /= length;
    const double inwards = normal.dot(opposite);
    if (std::abs(inwards) < kShadowMargin * opposite.norm()) return std::nullopt;  // edge-on
    if (inwards < 0.0) normal = -normal;
    shadow.goes_on[edge] = neighbours_->any_at_edge(triangle, edge, [&](const auto& neighbour) {
      const Eigen::Vector3d at =
          mesh.vertices_m[neighbour.opposite].template cast<double>() - pyramid.point();
      return neighbour.triangle != triangle && normal.dot(at) < -kShadowMargin * at.norm();
    });
    shadow.sides[edge] = {pyramid.frame().transpose() * normal,
                          shadow.goes_on[edge] ? 0.0 : kPlaneMargin};
  }
  return shadow;
}

/// Takes a shadow from all pieces; false, and nothing changed, when it meets none.
bool ShadowUnion::cut(const Shadow& shadow) {
  bool meets = false;
  Polygon inside;
  Polygon outside;
  const std::size_t before = pieces_.size();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < before; ++i) {
    const std::size_t had = pieces_.size();
    Polygon rest;
    if (!beside(pieces_[i], shadow)) {
      rest = pieces_[i];
      for (const Side& side : shadow.sides) {
        if (!split(rest, side, inside, outside)) too_many_corners_ = true;
        if (outside.size > 0) pieces_.push_back(outside);
        rest = inside;
        if (rest.size == 0) break;
      }
    }
    if (rest.size > 0) {
      meets = true;
      if (!shadow.before_box) in_front_.emplace_back(rest, shadow.plane);
    } else {
      pieces_.resize(had);
      if (kept != i) pieces_[kept] = pieces_[i];
      ++kept;
    }
  }
  pieces_.erase(pieces_.begin() + static_cast<std::ptrdiff_t>(kept),
                pieces_.begin() + static_cast<std::ptrdiff_t>(before));
  if (meets) {
    used_in_[shadow.triangle] = call_;
    used_.push_back(shadow);
  }
  return meets;
}

/// Whether the polygon lies wholly outside one side of the shadow.
bool ShadowUnion::beside(const Polygon& polygon, const Shadow& shadow) {
  return std::any_of(shadow.sides.begin(), shadow.sides.end(), [&](const Side& side) {
    return std::all_of(polygon.corners.begin(), polygon.corners.begin() + polygon.size,
                       [&](const Eigen::Vector2d& at) { return side.depth(at) <= kNothing; });
  });
}

/// Whether a triangle beyond the edge has been cut out too.
bool ShadowUnion::goes_on_in_used(const Shadow& shadow, std::size_t edge,
                                  const BoxPyramid& pyramid) const {
  const Eigen::Vector3d normal = pyramid.frame() * shadow.sides[edge].normal;
  return neighbours_->any_at_edge(shadow.triangle, edge, [&](const auto& neighbour) {
    const Eigen::Vector3d at =
        neighbours_->mesh().vertices_m[neighbour.opposite].template cast<double>() -
        pyramid.point();
    return used_in_[neighbour.triangle] == call_ && neighbour.triangle != shadow.triangle &&
           normal.dot(at) < -kShadowMargin * at.norm();
  });
}

/// Where the surface that goes on beyond an edge was not needed, something else hides it, mostly by
/// more than the margin: starts again with the margin there. False when there is no such edge.
bool ShadowUnion::pull_back_open_edges(const BoxPyramid& pyramid) {
  bool any = false;
  for (Shadow& shadow : used_) {
    for (std::size_t edge = 0; edge < 3; ++edge) {
      if (!shadow.goes_on[edge] || goes_on_in_used(shadow, edge, pyramid)) continue;
      shadow.goes_on[edge] = false;
      shadow.sides[edge].offset = kPlaneMargin;
      any = true;
    }
  }
  if (!any) return false;
  pieces_.assign(1, whole(pyramid));
  strips_.clear();
  in_front_.clear();
  std::vector<Shadow> again;
  again.swap(used_);
  ++call_;
  for (const Shadow& shadow : again) cut(shadow);
  return true;
}

/// The same for edges that came later: rays are to be cast beside them.
void ShadowUnion::add_strips_at_open_edges(const BoxPyramid& pyramid) {
  Polygon inside;
  Polygon outside;
  for (const Shadow& shadow : used_) {
    for (std::size_t edge = 0; edge < 3; ++edge) {
      if (!shadow.goes_on[edge] || goes_on_in_used(shadow, edge, pyramid)) continue;
      Polygon strip = whole(pyramid);
      for (std::size_t i = 0; i < 3 && strip.size > 0; ++i) {
        const Side around{shadow.sides[i].normal, -2.0 * kPlaneMargin};
        if (!split(strip, around, inside, outside)) too_many_corners_ = true;
        strip = inside;
      }
      const Side beside{-shadow.sides[edge].normal, -2.0 * kPlaneMargin};
      if (strip.size > 0 && !split(strip, beside, inside, outside)) too_many_corners_ = true;
      if (strip.size > 0 && inside.size > 0) strips_.push_back(inside);
    }
  }
}

/// Both parts of a convex polygon; of size 0 where there is next to nothing of it. False when it
/// has too many corners.
bool ShadowUnion::split(const Polygon& polygon, const Side& side, Polygon& inside,
                        Polygon& outside) {
  inside.size = 0;
  outside.size = 0;
  std::array<double, Polygon::kMostCorners> depths;
  double least = 0.0;
  double most = 0.0;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    depths[i] = side.depth(polygon.corners[i]);
    least = std::min(least, depths[i]);
    most = std::max(most, depths[i]);
  }
  if (most <= kNothing) {
    outside = polygon;
    return true;
  }
  if (least >= -kNothing) {
    inside = polygon;
    return true;
  }
  if (polygon.size + 2 > Polygon::kMostCorners) return false;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const std::size_t next = (i + 1) % polygon.size;
    Polygon& part = depths[i] >= 0.0 ? inside : outside;
    part.corners[part.size++] = polygon.corners[i];
    if ((depths[i] >= 0.0) != (depths[next] >= 0.0)) {
      const Eigen::Vector2d crossing =
          polygon.corners[i] +
          depths[i] / (depths[i] - depths[next]) * (polygon.corners[next] - polygon.corners[i]);
      inside.corners[inside.size++] = crossing;
      outside.corners[outside.size++] = crossing;
    }
  }
  return true;
}

/// All that the point sees of the box.
ShadowUnion::Polygon ShadowUnion::whole(const BoxPyramid& pyramid) {
  const Eigen::Array2d& least = pyramid.least_slope();
  const Eigen::Array2d& most = pyramid.most_slope();
  Polygon polygon;
  polygon.corners[0] = {least.x(), least.y()};
  polygon.corners[1] = {most.x(), least.y()};
  polygon.corners[2] = {most.x(), most.y()};
  polygon.corners[3] = {least.x(), most.y()};
  polygon.size = 4;
  return polygon;
}

}  // namespace nextview
