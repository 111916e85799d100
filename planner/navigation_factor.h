#pragma once

#include "planner/travel.h"

namespace nextview {

/// f_navigation (P18), in (0, 1]: how little reaching the view costs.
///
///     f_navigation = 1 / (1 + (length + kNavigationTurn_m turning) / kNavigationHalf_m)
///
/// of the path that the robot would take (Travel): 1 from where it stands, whatever way it looks,
/// 1/2 from kNavigationHalf_m straight ahead, and towards 0 the farther and the more winding the
/// way. A right angle costs as much as kNavigationTurn_m. A quotient and no exponential: it is the
/// same number on every machine.
double navigation_factor(const Travel& travel);

/// About half a room.
inline constexpr double kNavigationHalf_m = 2.0;
/// The simulated base drives 1 m in the time in which it turns by a right angle.
inline constexpr double kNavigationTurn_m = 1.0;

}  // namespace nextview
