#pragma once

#include "planner/prediction/view_counts.h"

namespace nextview {

/// How good a view is predicted to be, and why.
struct Fitness {
  double value = 0.0;                  ///< eq. 4
  double share_occupied = 0.0;         ///< a_ov, of the rays that meet anything but Empty
  double share_occlusion_plane = 0.0;  ///< a_op
  double share_unseen = 0.0;           ///< a_us; a_ov + a_op + a_us = 1 unless all rays are open
  double share_open = 0.0;             ///< of all rays
  double quality_factor = 0.0;         ///< f_quality in [0, 1]; 0 when it is not used
};

/// Eq. 3 (P16): f_area = (5 a_ov^3 - 10.5 a_ov^2 + 6 a_ov) (1 - |a_op - a_us| / 2).
/// Its maximum is 1.04, at a_ov = 0.4 and a_op = a_us. A view of nothing new scores 0.5.
double area_fitness(double a_ov, double a_op, double a_us);

/// P17: (share of the Occupied voxels met that would improve) x (their mean improvement, 0..1).
/// 0 when no Occupied voxel is met.
double quality_factor(const ViewCounts& counts);

/// Eq. 4: f = f_area (1 + f_quality), the last factor only with use_quality.
/// 0 when no ray meets anything but Empty: there is nothing to see.
Fitness fitness(const ViewCounts& counts, bool use_quality);

}  // namespace nextview
