#include "scoring/near_surface.h"

#include <algorithm>
#include <cmath>

namespace nextview {

bool triangle_meets_box(const std::array<Eigen::Vector3d, 3>& corners_m,
                        const Eigen::AlignedBox3d& box) {
  const Eigen::Vector3d center = box.center();
  const Eigen::Vector3d half_sides = 0.5 * box.sizes();
  const std::array<Eigen::Vector3d, 3> corners = {corners_m[0] - center, corners_m[1] - center,
                                                  corners_m[2] - center};
  const auto apart_along = [&](const Eigen::Vector3d& axis) {
    const auto [least, most] =
        std::minmax({axis.dot(corners[0]), axis.dot(corners[1]), axis.dot(corners[2])});
    const double reach = axis.cwiseAbs().dot(half_sides);
    return least > reach || most < -reach;
  };
  for (int i = 0; i < 3; ++i) {
    if (apart_along(Eigen::Vector3d::Unit(i))) return false;
  }
  const std::array<Eigen::Vector3d, 3> edges = {corners[1] - corners[0], corners[2] - corners[1],
                                                corners[0] - corners[2]};
  if (apart_along(edges[0].cross(edges[1]))) return false;
  for (const Eigen::Vector3d& edge : edges) {
    for (int i = 0; i < 3; ++i) {
      if (apart_along(Eigen::Vector3d::Unit(i).cross(edge))) return false;
    }
  }
  return true;
}

NearSurface::NearSurface(const TriangleMesh& mesh, const VoxelGrid& grid, const MapWindow& window,
                         const std::stop_token& stop)
    : window_(window),
      holds_(static_cast<std::size_t>(window.size.cast<std::int64_t>().prod()), false) {
  // A surface on the face between two voxels is beside the voxels two to either side of it, however
  // its coordinates were rounded.
  constexpr double kRounding_m = 1e-6;
  const double reach_m = 1.5 * grid.voxel_size_m + kRounding_m;
  const VoxelIndex last = window.min + window.size - VoxelIndex::Ones();
  // Indices far outside would overflow, and the window bounds what counts.
  const Eigen::AlignedBox3d counts(grid.center_m(window.min), grid.center_m(last));
  for (std::size_t i = 0; i < mesh.triangles.size() && !stop.stop_requested(); ++i) {
    const std::array<Eigen::Vector3d, 3> corners = {mesh.corner_m(i, 0), mesh.corner_m(i, 1),
                                                    mesh.corner_m(i, 2)};
    Eigen::AlignedBox3d bounds;
    for (const Eigen::Vector3d& corner : corners) bounds.extend(corner);
    bounds.min().array() -= reach_m;
    bounds.max().array() += reach_m;
    const Eigen::AlignedBox3d inside = bounds.intersection(counts);
    if (inside.isEmpty()) continue;
    const VoxelIndex first = grid.voxel_of(inside.min());
    for_each_voxel({first, grid.voxel_of(inside.max()) - first + VoxelIndex::Ones()},
                   [&](const VoxelIndex& voxel) {
                     const std::size_t number = number_of(voxel);
                     if (holds_[number]) return;
                     const Eigen::Vector3d center = grid.center_m(voxel);
                     const Eigen::Vector3d reach = Eigen::Vector3d::Constant(reach_m);
                     holds_[number] = triangle_meets_box(corners, {center - reach, center + reach});
                   });
  }
}

std::size_t NearSurface::number_of(const VoxelIndex& voxel) const {
  const auto at = (voxel - window_.min).cast<std::size_t>();
  const auto size = window_.size.cast<std::size_t>();
  return at[0] + size[0] * (at[1] + size[1] * at[2]);
}

}  // namespace nextview
