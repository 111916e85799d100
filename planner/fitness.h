#pragma once

#include "planner/factors.h"
#include "planner/prediction/view_counts.h"
#include "planner/travel.h"

namespace nextview {

/// How good a view is predicted to be, and why.
struct Fitness {
  double value = 0.0;                  ///< eq. 4
  double share_occupied = 0.0;         ///< a_ov, of the rays that meet anything but Empty
  double share_occlusion_plane = 0.0;  ///< a_op
  double share_unseen = 0.0;           ///< a_us; a_ov + a_op + a_us = 1 unless all rays are open
  double share_open = 0.0;             ///< of all rays
  FactorValues factors = {};           ///< f_i by kFactors, in [0, 1]; 0 when not worked out
};

/// Eq. 3 (P16): f_area = (5 a_ov^3 - 10.5 a_ov^2 + 6 a_ov) (1 - |a_op - a_us| / 2).
/// Its maximum is 1.04, at a_ov = 0.4 and a_op = a_us. A view of nothing new scores 0.5.
double area_fitness(double a_ov, double a_op, double a_us);

/// Eq. 4: f = f_area x product over the factors of (1 + weight_i f_i). With weights of 1 it is the
/// paper's; a weight is how much the factor may add at most, in parts of what is there without it,
/// and with 0 the product is the same number as without the factor.
/// 0 when no ray meets anything but Empty: there is nothing to see.
/// @param travel of the path to the view; needed when the weights ask for it, and so are the
///        surface counts
Fitness fitness(const ViewCounts& counts, const Travel& travel, const FactorWeights& weights);

/// Eq. 3 alone: of a view whose factors do not count.
inline Fitness fitness(const ViewCounts& counts) { return fitness(counts, {}, {}); }

}  // namespace nextview
