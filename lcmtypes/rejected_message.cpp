#include "lcmtypes/rejected_message.h"

#include <string>

namespace nextview {

void check_fits_run(const run_config_t& config, std::int32_t view, std::int32_t attempt) {
  const planner_config_t& planner = config.planner;
  if (view <= planner.max_views && attempt <= planner.max_attempts) return;
  throw RejectedMessage("view " + std::to_string(view) + ", attempt " + std::to_string(attempt) +
                        " of a run of " + std::to_string(planner.max_views) + " views, " +
                        std::to_string(planner.max_attempts) + " attempts each");
}

}  // namespace nextview
