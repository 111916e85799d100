#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "bench/ray_meeting.h"
#include "mapper/voxel_map.h"

namespace nextview {

/// Labels in a plain dense array, x fastest: what the textbook kernel walks through.
struct DenseLabels {
  explicit DenseLabels(const MapWindow& covered)
      : window(covered),
        stride{1, covered.size[0], std::ptrdiff_t{covered.size[0]} * covered.size[1]},
        labels(static_cast<std::size_t>(stride[2] * covered.size[2]), Label::Unmarked) {}
  explicit DenseLabels(const VoxelMap& map) : DenseLabels(map.window()) {
    for (int k = 0; k < window.size[2]; ++k) {
      for (int j = 0; j < window.size[1]; ++j) {
        for (int i = 0; i < window.size[0]; ++i) {
          const VoxelIndex index = window.min + VoxelIndex(i, j, k);
          labels[static_cast<std::size_t>(offset(index))] = map.label(index);
        }
      }
    }
  }

  std::ptrdiff_t offset(const VoxelIndex& index) const {
    const VoxelIndex cell = index - window.min;
    return cell[0] + cell[1] * stride[1] + cell[2] * stride[2];
  }
  Label at(const VoxelIndex& index) const {
    return window.contains(index) ? labels[static_cast<std::size_t>(offset(index))]
                                  : Label::Unmarked;
  }

  MapWindow window;
  std::ptrdiff_t stride[3];
  std::vector<Label> labels;
};

/// The walk of Amanatides and Woo (1987) in double, as the paper and every textbook has it: from
/// voxel to voxel through the face the ray leaves by (6-connected), the array's limits as "just
/// out" indices per axis, and the array offset stepped along. Positions are in voxels, voxel i
/// covers [i - 1/2, i + 1/2).
///
/// Calls visit(offset, t) for every voxel after the one the origin lies in, entered at distance t,
/// until visit returns false, the ray leaves the window, or it has gone `reach`.
template <class Visit>
void walk_textbook(const DenseLabels& dense, const Eigen::Vector3d& origin,
                   const Eigen::Vector3d& direction, double reach, Visit&& visit) {
  int voxel[3];
  int just_out[3];
  int step[3];
  double t_max[3];
  double t_delta[3];
  std::ptrdiff_t offset = 0;
  std::ptrdiff_t offset_step[3];
  for (int axis = 0; axis < 3; ++axis) {
    voxel[axis] = static_cast<int>(std::floor(origin[axis] + 0.5));
    const int min = dense.window.min[axis];
    offset += (voxel[axis] - min) * dense.stride[axis];
    step[axis] = direction[axis] < 0.0 ? -1 : 1;
    offset_step[axis] = step[axis] * dense.stride[axis];
    just_out[axis] = step[axis] < 0 ? min - 1 : min + dense.window.size[axis];
    if (direction[axis] == 0.0) {
      t_max[axis] = t_delta[axis] = std::numeric_limits<double>::infinity();
    } else {
      const double boundary = voxel[axis] + 0.5 * step[axis];
      t_max[axis] = (boundary - origin[axis]) / direction[axis];
      t_delta[axis] = step[axis] / direction[axis];
    }
  }
  for (;;) {
    const int axis =
        t_max[0] < t_max[1] ? (t_max[0] < t_max[2] ? 0 : 2) : (t_max[1] < t_max[2] ? 1 : 2);
    const double t = t_max[axis];
    if (t > reach) return;
    voxel[axis] += step[axis];
    if (voxel[axis] == just_out[axis]) return;
    offset += offset_step[axis];
    t_max[axis] += t_delta[axis];
    if (!visit(static_cast<std::size_t>(offset), t)) return;
  }
}

/// What the textbook kernel says a ray meets.
class TextbookCaster {
 public:
  TextbookCaster(const VoxelMap& map, double reach_voxels) : dense_(map), reach_(reach_voxels) {}

  Meeting cast(const VoxelIndex& sensor, const Eigen::Vector3d& direction) const {
    Label met = Label::Empty;
    walk_textbook(dense_, sensor.cast<double>(), direction, reach_,
                  [&](std::size_t offset, double) {
                    met = dense_.labels[offset];
                    return met == Label::Empty;
                  });
    return meeting_of(met);
  }

 private:
  DenseLabels dense_;
  double reach_;
};

}  // namespace nextview
