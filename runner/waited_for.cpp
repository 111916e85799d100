#include "runner/waited_for.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace nextview {
namespace {

using Roles = std::vector<std::string>;

std::string who_is(const std::string& role, const Roles& answering) {
  const bool started = std::find(answering.begin(), answering.end(), role) != answering.end();
  return started ? role : "the driver in place of " + role;
}

std::string before_the_configuration(const HeardRun& heard, const Roles& answering) {
  std::string who;
  for (const std::string& role : answering) {
    if (!heard.asked_for_config.contains(role)) who += (who.empty() ? "" : ", ") + role;
  }
  return "nothing was heard of " + (who.empty() ? "lcm-logger, which has recorded nothing" : who);
}

}  // namespace

std::string waited_for(const HeardRun& heard, const Roles& answering) {
  if (!heard.record.config()) return before_the_configuration(heard, answering);
  for (const std::string& role : answering) {
    if (!heard.statuses.contains(role)) return role + " did not get ready";
  }
  const RunRecord& record = heard.record;
  const int view = record.latest_view();
  int attempt = 0;
  while (record.goal(view, attempt + 1)) ++attempt;
  const arrival_t* arrival = record.arrival(view, attempt);
  if (record.commit(view) || view == 0 || (arrival && !arrival->arrived)) {
    return fmt::format("the planner gave no goal after view {}", view);
  }
  if (!arrival) {
    return fmt::format("{} did not answer the goal of view {}", who_is("base_sim", answering),
                       view);
  }
  if (!record.range_image(view, attempt)) {
    return fmt::format("{} sent no range image of view {}", who_is("sensor_sim", answering), view);
  }
  return fmt::format("the mapper did not commit the range image of view {}", view);
}

double watched_motion_s(const RunRecord& record, const run_config_t& config, double real_time) {
  if (real_time <= 0.0) return 0.0;
  const goal_t* goal =
      record.goal(record.latest_view(), record.final_attempt(record.latest_view()));
  if (goal == nullptr) return 0.0;
  const base_config_t& base = config.base;
  constexpr double kWholeTurn = 2.0 * std::numbers::pi;
  const double motion_s =
      std::max(goal->path_length_m / std::min(base.base_speed_m_s, base.lift_speed_m_s),
               kWholeTurn / base.turn_speed_rad_s);
  return (motion_s + config.sensor.scan_duration_s) / real_time;
}

}  // namespace nextview
