#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "planner/prediction/view_counts.h"

namespace nextview {

/// P17: (share of the Occupied voxels met that would improve) x (their mean improvement, 0..1).
/// 0 when no Occupied voxel is met.
double quality_factor(const ViewCounts& counts);

/// A secondary criterion of eq. 4, in [0, 1].
struct Factor {
  std::string_view name;  ///< in messages and tables
  double (*of)(const ViewCounts&);
};
/// All there are. One more is a function with its test, and a line here.
inline constexpr std::array<Factor, 1> kFactors = {{{"quality", quality_factor}}};
/// What each counts in eq. 4: 1 as in the paper, 0 not at all and not worked out.
using FactorWeights = std::array<double, kFactors.size()>;
/// The place of a factor in the list.
constexpr std::size_t kQualityFactor = 0;

/// How good a view is predicted to be, and why.
struct Fitness {
  double value = 0.0;                  ///< eq. 4
  double share_occupied = 0.0;         ///< a_ov, of the rays that meet anything but Empty
  double share_occlusion_plane = 0.0;  ///< a_op
  double share_unseen = 0.0;           ///< a_us; a_ov + a_op + a_us = 1 unless all rays are open
  double share_open = 0.0;             ///< of all rays
  FactorWeights factors = {};          ///< f_i by kFactors, in [0, 1]; 0 when not worked out
};

/// Eq. 3 (P16): f_area = (5 a_ov^3 - 10.5 a_ov^2 + 6 a_ov) (1 - |a_op - a_us| / 2).
/// Its maximum is 1.04, at a_ov = 0.4 and a_op = a_us. A view of nothing new scores 0.5.
double area_fitness(double a_ov, double a_op, double a_us);

/// Eq. 4: f = f_area x product over the factors of (1 + weight_i f_i).
/// 0 when no ray meets anything but Empty: there is nothing to see.
Fitness fitness(const ViewCounts& counts, const FactorWeights& weights);

}  // namespace nextview
