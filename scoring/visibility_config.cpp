#include "scoring/visibility_config.h"

#include <algorithm>

namespace nextview {

VisibilityParameters visibility_of(const run_config_t& config) {
  VisibilityParameters visibility;
  visibility.range_max_m = config.sensor.range_max_m;
  ReachParameters& reach = visibility.reach;
  reach.clearance_m = config.planner.clearance_m;
  reach.box_min_m = Eigen::Vector3d(config.base.workspace_min_m);
  reach.box_max_m = Eigen::Vector3d(config.base.workspace_max_m);
  reach.box_min_m.z() = std::max(reach.box_min_m.z(), config.base.lift_min_m);
  reach.box_max_m.z() = std::min(reach.box_max_m.z(), config.base.lift_max_m);
  return visibility;
}

}  // namespace nextview
