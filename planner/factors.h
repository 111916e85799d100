#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "planner/navigation_factor.h"
#include "planner/prediction/view_counts.h"
#include "planner/quality_factor.h"
#include "planner/structure_factor.h"
#include "planner/travel.h"

namespace nextview {

/// A secondary criterion of eq. 4 (P17, P18), in [0, 1]: of the surfaces a view would meet, or of
/// the way there.
struct Factor {
  std::string_view name;                          ///< in messages and tables
  double (*of_surfaces)(const ViewCounts&) = {};  ///< of their counts; or null, and
  double (*of_travel)(const Travel&) = {};        ///< of the path
  double default_weight = 0.0;                    ///< see FactorWeights
};

/// All there are. One more is a pair of files with its test, and a line here; what it counts has to
/// travel in the configuration (factor_weights_of, planner_config.h).
inline constexpr std::array<Factor, 3> kFactors = {{
    {.name = "quality", .of_surfaces = quality_factor},
    {.name = "structure", .of_surfaces = structure_factor},
    {.name = "navigation", .of_travel = navigation_factor},
}};

/// A value for each factor, in the order of kFactors.
using FactorValues = std::array<double, kFactors.size()>;
/// What each counts in eq. 4: 1 as in the paper, 0 not at all and not worked out.
using FactorWeights = FactorValues;

/// The place of a factor in the list; that of no factor is its end.
constexpr std::size_t factor_number(std::string_view name) {
  std::size_t number = 0;
  while (number < kFactors.size() && kFactors[number].name != name) ++number;
  return number;
}
inline constexpr std::size_t kQualityFactor = factor_number("quality");
inline constexpr std::size_t kStructureFactor = factor_number("structure");
inline constexpr std::size_t kNavigationFactor = factor_number("navigation");

/// Whether what counts asks for surface counts, or for paths.
constexpr bool ask_for_surfaces(const FactorWeights& weights) {
  for (std::size_t i = 0; i < kFactors.size(); ++i) {
    if (weights[i] != 0.0 && kFactors[i].of_surfaces != nullptr) return true;
  }
  return false;
}
constexpr bool ask_for_travel(const FactorWeights& weights) {
  for (std::size_t i = 0; i < kFactors.size(); ++i) {
    if (weights[i] != 0.0 && kFactors[i].of_travel != nullptr) return true;
  }
  return false;
}

constexpr FactorWeights default_weights() {
  FactorWeights weights = {};
  for (std::size_t i = 0; i < kFactors.size(); ++i) weights[i] = kFactors[i].default_weight;
  return weights;
}

}  // namespace nextview
