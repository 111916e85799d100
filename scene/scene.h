#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "scene/triangle_mesh.h"

namespace nextview {

/// Ray casting and distances in a triangle mesh; surfaces are seen from both sides. World frame,
/// metres. All questions are const and may be asked from several threads.
class Scene {
 public:
  static constexpr int kPacketSize = 16;
  /// Directions of 16 rays, unit vectors of the world frame.
  struct Directions {
    alignas(64) std::array<float, kPacketSize> x;
    alignas(64) std::array<float, kPacketSize> y;
    alignas(64) std::array<float, kPacketSize> z;
  };
  /// Distances along 16 rays; +inf where nothing is met.
  struct Distances {
    alignas(64) std::array<float, kPacketSize> m;
  };
  struct Hit {
    float distance_m;        ///< in lengths of the direction given
    std::uint32_t triangle;  ///< index into mesh().triangles
  };

  /// @throws std::invalid_argument for a mesh without triangles, with indices out of range or with
  /// vertices that are not finite
  explicit Scene(TriangleMesh mesh);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  const TriangleMesh& mesh() const { return mesh_; }

  /// Distances from one origin along many directions, 16 at a time: the one path that all scans
  /// take, because packets and single rays may differ in the last bit. Packets of neighbouring rays
  /// are fastest. Both spans have the same size.
  void cast(const Eigen::Vector3f& origin_m, std::span<const Directions> directions,
            std::span<Distances> distances) const;

  /// The first surface along a ray, if any. Computed in float like all of this class.
  std::optional<Hit> first_hit(const Eigen::Vector3d& origin_m,
                               const Eigen::Vector3d& direction) const;

  /// Distance from the segment ab to the nearest triangle, exact in double, or at_most_m (which may
  /// be infinite) when none is nearer. 0 when the segment meets a triangle.
  double clearance_m(const Eigen::Vector3d& a_m, const Eigen::Vector3d& b_m,
                     double at_most_m) const;

 private:
  struct Embree;
  TriangleMesh mesh_;
  std::unique_ptr<Embree> embree_;
};

}  // namespace nextview
