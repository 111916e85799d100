#include "planner/navigation_factor.h"

namespace nextview {

double navigation_factor(const Travel& travel) {
  return 1.0 / (1.0 + (travel.length_m + kNavigationTurn_m * travel.turning) / kNavigationHalf_m);
}

}  // namespace nextview
