#include "logger/unchecked_fields.h"

#include <algorithm>

#include "logger/expected_message.h"
#include "logger/message_fields.h"

namespace nextview {
namespace {

/// What a replay looks at; of these the fields that it does not check are named below.
using LookedAt =
    TypeList<run_config_t, goal_t, search_t, arrival_t, range_image_t, commit_t, stop_t, seal_t>;

template <class Message, class... Messages>
constexpr bool is_among(TypeList<Messages...>) {
  return (std::is_same_v<Message, Messages> || ...);
}

template <class Message>
std::vector<std::string> all_fields() {
  std::vector<std::string> fields;
  for_each_field<Message>([&](const std::string& field, const auto&) { fields.push_back(field); });
  return fields;
}

template <class Message>
std::string_view why_not_looked_at() {
  if constexpr (std::is_same_v<Message, map_blocks_t>) {
    return "for others that follow the map, whose digest is in the commits";
  }
  return "for people, or of the moment";
}

}  // namespace

std::vector<UncheckedFields> unchecked_fields(const RunRecord& run, bool planner) {
  constexpr std::string_view kConfig = Channel<run_config_t>::name;
  constexpr std::string_view kGoal = Channel<goal_t>::name;
  constexpr std::string_view kSearch = Channel<search_t>::name;
  constexpr std::string_view kArrival = Channel<arrival_t>::name;
  constexpr std::string_view kStop = Channel<stop_t>::name;
  const std::vector<std::string> kBelievedPose = {"believed_position_m", "believed_pan_rad",
                                                  "believed_tilt_rad"};
  constexpr std::string_view kForPeople = "for people, or of the moment";
  std::vector<UncheckedFields> unchecked = {
      {kForPeople, kConfig, {"scene_name", "program_version", "planner.threads"}},
      {"only the scene could tell, which a replay does not read",
       kConfig,
       {"scene.unit_m", "scene.origin_in_file_m", "scene_file", "scene_up", "scene_digest",
        "sensor.range_noise_m"}},
      {"only the scene could tell, which a replay does not read", kArrival, {"refusal"}},
      {"how long a motion takes, the base says",
       kConfig,
       {"base.base_speed_m_s", "base.lift_speed_m_s", "base.turn_speed_rad_s"}},
      {"shows only where a decision depends on it",
       kConfig,
       {"base.body_radius_m",        "base.workspace_min_m",  "base.workspace_max_m",
        "base.lift_min_m",           "base.lift_max_m",       "planner.max_attempts",
        "planner.max_evaluations",   "planner.step_min_m",    "planner.step_max_m",
        "planner.fitness_tolerance", "planner.clearance_m",   "planner.departure_m",
        "planner.quality_threshold", "planner.stop_rule",     "planner.stop_window_views",
        "planner.stop_new_area_m2",  "planner.max_views",     "planner.path_cost_per_m",
        "planner.later_departure_m", "planner.least_overlap", "planner.least_gain_m2",
        "planner.return_home"}},
  };
  for_each_channel([&]<class Message>() {
    if constexpr (!is_among<Message>(LookedAt{})) {
      unchecked.push_back(
          {why_not_looked_at<Message>(), Channel<Message>::name, all_fields<Message>()});
    }
  });
  if (run.ends_early()) {
    unchecked.push_back(
        {"why a run ended early, it says itself", kStop, {"stop_reason", "detail"}});
  }
  const Simulated simulated = simulated_in(run);
  if (!simulated.base) {
    unchecked.push_back({"what a robot of one's own says is believed",
                         kArrival,
                         {"true_position_m", "true_pan_rad", "true_tilt_rad", "path_length_m"}});
    unchecked.push_back(
        {"where a robot of one's own has refused to go on is believed", kArrival, kBelievedPose});
  }
  if (!simulated.base && !simulated.sensor) {
    unchecked.push_back({"what a robot of one's own says is believed", kArrival, {"utime"}});
  }
  if (!simulated.sensor) {
    unchecked.push_back({"what a sensor of one's own says of itself is believed",
                         kConfig,
                         {"sensor.geometry_parameter", "sensor.range_min_m", "sensor.range_max_m",
                          "sensor.scan_duration_s"}});
    unchecked.push_back(
        {"held against a range image of one's own to a millionth only", kArrival, kBelievedPose});
  } else {
    unchecked.push_back({"sines and cosines are compared to a millionth only",
                         kConfig,
                         {"sensor.geometry_parameter"}});
  }
  if (!planner) {
    constexpr std::string_view kDecided = "decided again with --planner only";
    if (run.ends_by_search()) {
      unchecked.push_back({kDecided, kStop, {"stop_reason", "final_attempt", "detail"}});
    }
    unchecked.push_back({"of a goal that was refused, decided again with --planner only",
                         kGoal,
                         {"pan_rad", "tilt_rad"}});
    unchecked.push_back(
        {kDecided,
         kGoal,
         {"waypoints", "factors", "fitness", "share_occupied", "share_occlusion_plane",
          "share_unseen", "share_open", "factor_value", "expected_gain_m2", "overlap", "iterations",
          "evaluations", "factor_names", "reason"}});
    unchecked.push_back({kDecided,
                         kSearch,
                         {"tried", "tried_position_m", "tried_pan_rad", "tried_tilt_rad",
                          "tried_fitness", "tried_move"}});
    unchecked.push_back({kDecided,
                         kConfig,
                         {"seed", "planner.directions", "planner.quality_weight",
                          "planner.structure_weight", "planner.navigation_weight"}});
  }
  return unchecked;
}

bool is_unchecked(std::span<const UncheckedFields> unchecked, std::string_view channel,
                  const std::string& field) {
  return std::any_of(unchecked.begin(), unchecked.end(), [&](const UncheckedFields& some) {
    return some.channel == channel &&
           std::any_of(some.fields.begin(), some.fields.end(),
                       [&](const std::string& name) { return name == field; });
  });
}

}  // namespace nextview
