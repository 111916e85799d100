#include "scoring/surface_shadow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace nextview {
namespace {

/// A shadow counts only this far (radians and metres) inside its border: more than the rounding of
/// a ray cast in float, so that casting every ray would say the same.
constexpr double kShadowMargin = 1e-5;

/// A shadow that takes more triangles is cheaper shown in parts, for smaller boxes.
constexpr std::size_t kMostTriangles = 200;

/// Numbers under which vertices with the same coordinates are the same.
std::vector<std::uint32_t> merged_vertices(const TriangleMesh& mesh) {
  const auto coordinates = [&](std::uint32_t i) {
    const Eigen::Vector3f& vertex = mesh.vertices_m[i];
    return std::tuple(vertex.x(), vertex.y(), vertex.z());
  };
  std::vector<std::uint32_t> order(mesh.vertices_m.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return coordinates(a) < coordinates(b); });
  std::vector<std::uint32_t> merged(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool repeated = i > 0 && coordinates(order[i]) == coordinates(order[i - 1]);
    merged[order[i]] = repeated ? merged[order[i - 1]] : order[i];
  }
  return merged;
}

}  // namespace

TriangleNeighbours::TriangleNeighbours(const TriangleMesh& mesh) : mesh_(&mesh) {
  struct Edge {
    std::uint32_t low;
    std::uint32_t high;
    std::uint32_t of_triangle;  // 3 triangle + edge
  };
  const std::vector<std::uint32_t> merged = merged_vertices(mesh);
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = merged[mesh.triangles[t][k]];
      const std::uint32_t b = merged[mesh.triangles[t][(k + 1) % 3]];
      edges.push_back({std::min(a, b), std::max(a, b), 3 * t + k});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.of_triangle) < std::tie(b.low, b.high, b.of_triangle);
  });
  run_of_edge_.resize(edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i == 0 || edges[i].low != edges[i - 1].low || edges[i].high != edges[i - 1].high) {
      run_start_.push_back(static_cast<std::uint32_t>(i));
    }
    const std::uint32_t triangle = edges[i].of_triangle / 3;
    at_edges_.push_back({triangle, mesh.triangles[triangle][(edges[i].of_triangle + 2) % 3]});
    run_of_edge_[edges[i].of_triangle] = static_cast<std::uint32_t>(run_start_.size()) - 1;
  }
  run_start_.push_back(static_cast<std::uint32_t>(edges.size()));
}

/// What a point sees of a box: a pyramid of four sides around its directions, and what lies nearer.
/// Coordinates are relative to the point.
class SurfaceShadow::Pyramid {
 public:
  Pyramid(const Eigen::Vector3d& point_m, const Eigen::AlignedBox3d& box)
      : point_(point_m), center_(box.center() - point_m), half_sides_(0.5 * box.sizes()) {
    const Eigen::Vector3d axis = center_.normalized();
    const Eigen::Vector3d side = axis.unitOrthogonal();
    frame_.col(0) = side;
    frame_.col(1) = axis.cross(side);
    frame_.col(2) = axis;
    nearest_ = axis.dot(center_) - axis.cwiseAbs().dot(half_sides_);
    farthest_ = center_.norm() + half_sides_.norm();
    if (nearest_ <= kLineOfSightGap_m) return;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d signs((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0,
                                  (corner & 4) != 0 ? 1.0 : -1.0);
      const Eigen::Vector3d seen = frame_.transpose() * (center_ + signs.cwiseProduct(half_sides_));
      const Eigen::Array2d slope = seen.head<2>().array() / seen.z();
      least_ = least_.min(slope - kShadowMargin);
      most_ = most_.max(slope + kShadowMargin);
    }
  }

  /// Whether the whole box lies before the point, so that the rest has a meaning.
  bool exists() const { return nearest_ > kLineOfSightGap_m; }

  struct Corner {
    Eigen::Vector3d at;
    double depth;
    unsigned outside;  ///< a bit for each side of the pyramid
  };
  Corner corner(const Eigen::Vector3f& vertex_m) const {
    const Eigen::Vector3d at = vertex_m.cast<double>() - point_;
    const Eigen::Vector3d seen = frame_.transpose() * at;
    const unsigned outside = (seen.x() < least_.x() * seen.z() - kShadowMargin ? 1U : 0U) |
                             (seen.x() > most_.x() * seen.z() + kShadowMargin ? 2U : 0U) |
                             (seen.y() < least_.y() * seen.z() - kShadowMargin ? 4U : 0U) |
                             (seen.y() > most_.y() * seen.z() + kShadowMargin ? 8U : 0U);
    return {at, seen.z(), outside};
  }

  /// Whether all rays to the box that meet the triangle do so after they started and before they
  /// arrive.
  bool is_behind(const std::array<Corner, 3>& corners) const {
    const auto [low, high] = std::minmax({corners[0].depth, corners[1].depth, corners[2].depth});
    const bool after_start = low > kLineOfSightGap_m + kShadowMargin;
    const bool before_end = high < nearest_ - kShadowMargin;
    if (after_start && before_end) return true;
    Eigen::Vector3d normal =
        (corners[1].at - corners[0].at).cross(corners[2].at - corners[0].at).normalized();
    if (normal.dot(corners[0].at) < 0.0) normal = -normal;
    const double plane = normal.dot(corners[0].at);
    return (after_start || plane > kLineOfSightGap_m + kShadowMargin) &&
           (before_end ||
            normal.dot(center_) - normal.cwiseAbs().dot(half_sides_) > plane + kShadowMargin);
  }

  /// Whether a plane through the point leaves the whole box on one side.
  bool is_beside(const Eigen::Vector3d& normal) const {
    return std::abs(normal.dot(center_)) - normal.cwiseAbs().dot(half_sides_) >
           kShadowMargin * farthest_ * normal.norm();
  }

  const Eigen::Vector3d& point() const { return point_; }

 private:
  Eigen::Vector3d point_;
  Eigen::Vector3d center_;
  Eigen::Vector3d half_sides_;
  Eigen::Matrix3d frame_;  ///< the third axis points to the middle of the box
  double nearest_ = 0.0;   ///< along the third axis
  double farthest_ = 0.0;
  Eigen::Array2d least_ = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array2d most_ = -least_;  ///< sideways over depth
};

SurfaceShadow::SurfaceShadow(const TriangleNeighbours& neighbours)
    : neighbours_(&neighbours), grown_in_(neighbours.mesh().triangles.size(), 0) {}

bool SurfaceShadow::covers(std::uint32_t triangle, const Eigen::Vector3d& point_m,
                           const Eigen::Vector3d& target_m) const {
  const TriangleMesh& mesh = neighbours_->mesh();
  const Eigen::Vector3d a = mesh.corner_m(triangle, 0) - point_m;
  const Eigen::Vector3d b = mesh.corner_m(triangle, 1) - point_m;
  const Eigen::Vector3d c = mesh.corner_m(triangle, 2) - point_m;
  const Eigen::Vector3d target = target_m - point_m;
  const Eigen::Vector3d normal = a.cross(b);
  const double side = normal.dot(c) < 0.0 ? -1.0 : 1.0;
  return side * normal.dot(target) > 0.0 && side * b.cross(c).dot(target) > 0.0 &&
         side * c.cross(a).dot(target) > 0.0;
}

bool SurfaceShadow::hides(std::uint32_t triangle, const Eigen::Vector3d& point_m,
                          const Eigen::Vector3d& target_m, const Eigen::AlignedBox3d& box) {
  if (!covers(triangle, point_m, target_m)) return false;
  const Pyramid pyramid(point_m, box);
  if (!pyramid.exists()) return false;
  ++call_;
  grown_.assign(1, triangle);
  grown_in_[triangle] = call_;
  for (std::size_t i = 0; i < grown_.size(); ++i) {
    if (grown_.size() > kMostTriangles || !grow_over(grown_[i], pyramid)) return false;
  }
  return true;
}

/// Adds what the pyramid meets next to a triangle; false where it meets a border of the shadow.
bool SurfaceShadow::grow_over(std::uint32_t triangle, const Pyramid& pyramid) {
  const TriangleMesh& mesh = neighbours_->mesh();
  const auto& vertices = mesh.triangles[triangle];
  const std::array<Pyramid::Corner, 3> corners = {pyramid.corner(mesh.vertices_m[vertices[0]]),
                                                  pyramid.corner(mesh.vertices_m[vertices[1]]),
                                                  pyramid.corner(mesh.vertices_m[vertices[2]])};
  if (!pyramid.is_behind(corners)) return false;
  for (std::size_t edge = 0; edge < 3; ++edge) {
    const Pyramid::Corner& from = corners[edge];
    const Pyramid::Corner& to = corners[(edge + 1) % 3];
    if ((from.outside & to.outside) != 0) continue;
    const Eigen::Vector3d normal = from.at.cross(to.at);
    if (pyramid.is_beside(normal)) continue;
    const bool this_side = normal.dot(corners[(edge + 2) % 3].at) > 0.0;
    const bool grown = neighbours_->any_at_edge(triangle, edge, [&](const auto& neighbour) {
      if (neighbour.triangle == triangle) return false;
      const Eigen::Vector3d at =
          mesh.vertices_m[neighbour.opposite].template cast<double>() - pyramid.point();
      const double side = normal.dot(at);
      if (this_side ? side >= 0.0 : side <= 0.0) return false;
      if (grown_in_[neighbour.triangle] != call_) {
        grown_in_[neighbour.triangle] = call_;
        grown_.push_back(neighbour.triangle);
      }
      return true;
    });
    if (!grown) return false;
  }
  return true;
}

}  // namespace nextview
