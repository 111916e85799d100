#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "scene/triangle_mesh.h"

namespace nextview {

/// Rays to a surface point start this far off it, so that the surface does not hide its own points.
constexpr double kLineOfSightGap_m = 0.001;

/// A shadow counts only this far (radians and metres) inside its border: more than the rounding of
/// a ray cast in float, so that casting every ray would say the same.
constexpr double kShadowMargin = 1e-5;

/// What a point sees of a box: a pyramid of four sides around its directions, and what lies nearer.
/// Coordinates are relative to the point.
class BoxPyramid {
 public:
  BoxPyramid(const Eigen::Vector3d& point_m, const Eigen::AlignedBox3d& box)
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
  std::array<Corner, 3> corners(const TriangleMesh& mesh, std::uint32_t triangle) const {
    const auto& vertices = mesh.triangles[triangle];
    return {corner(mesh.vertices_m[vertices[0]]), corner(mesh.vertices_m[vertices[1]]),
            corner(mesh.vertices_m[vertices[2]])};
  }

  /// Whether all rays to the box that meet the triangle do so after they started and before they
  /// arrive.
  bool is_behind(const std::array<Corner, 3>& corners) const {
    return is_after_start(corners) && is_before_box(corners);
  }
  bool is_after_start(const std::array<Corner, 3>& corners) const {
    constexpr double kStart = kLineOfSightGap_m + kShadowMargin;
    return std::min({corners[0].depth, corners[1].depth, corners[2].depth}) > kStart ||
           plane_of(corners).offset > kStart;
  }
  bool is_before_box(const std::array<Corner, 3>& corners) const {
    const double farthest = std::max({corners[0].depth, corners[1].depth, corners[2].depth});
    if (farthest < nearest_ - kShadowMargin) return true;
    const Plane plane = plane_of(corners);
    return plane.normal.dot(center_) - plane.normal.cwiseAbs().dot(half_sides_) >
           plane.offset + kShadowMargin;
  }

  /// normal . x = offset, which is not negative.
  struct Plane {
    Eigen::Vector3d normal;
    double offset;
  };
  static Plane plane_of(const std::array<Corner, 3>& corners) {
    const Eigen::Vector3d normal =
        (corners[1].at - corners[0].at).cross(corners[2].at - corners[0].at).normalized();
    const double offset = normal.dot(corners[0].at);
    return offset < 0.0 ? Plane{-normal, -offset} : Plane{normal, offset};
  }

  /// Whether a plane through the point leaves the whole box on one side.
  bool is_beside(const Eigen::Vector3d& normal) const {
    return std::abs(normal.dot(center_)) - normal.cwiseAbs().dot(half_sides_) >
           kShadowMargin * farthest_ * normal.norm();
  }

  const Eigen::Vector3d& point() const { return point_; }
  /// Columns: two directions sideways, and that to the middle of the box.
  const Eigen::Matrix3d& frame() const { return frame_; }
  /// The four sides, sideways over depth.
  const Eigen::Array2d& least_slope() const { return least_; }
  const Eigen::Array2d& most_slope() const { return most_; }

 private:
  Eigen::Vector3d point_;
  Eigen::Vector3d center_;
  Eigen::Vector3d half_sides_;
  Eigen::Matrix3d frame_;
  double nearest_ = 0.0;  ///< along the third axis
  double farthest_ = 0.0;
  Eigen::Array2d least_ = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array2d most_ = -least_;
};

}  // namespace nextview
