#include "planner/termination.h"

#include <array>
#include <stdexcept>

#include "lcmtypes/parameter_bounds.h"

namespace nextview {

namespace {

constexpr std::array<StopReason, 11> kStopReasons = {
    StopReason::NothingLeft,    StopReason::NothingNew, StopReason::QualityReached,
    StopReason::NoImprovement,  StopReason::ViewLimit,  StopReason::NoFeasibleGoal,
    StopReason::DigestMismatch, StopReason::NoAnswer,   StopReason::ProcessDied,
    StopReason::BusFailed,      StopReason::Interrupted};

constexpr std::array<StopRule, 3> kStopRules = {StopRule::NothingNew, StopRule::Quality,
                                                StopRule::NoImprovement};

bool nothing_new(std::span<const ViewFacts> views, const StopParameters& parameters) {
  const auto window = static_cast<std::size_t>(parameters.stop_window_views);
  if (views.size() <= window) return false;
  double area_m2 = 0.0;
  for (const ViewFacts& view : views.last(window)) area_m2 += view.newly_occupied_area_m2;
  return area_m2 < parameters.stop_new_area_m2;
}

// Of more views than the window has. The mean falls a little when a surface comes in that is first
// seen at a slant; that is no improvement either.
bool no_improvement(std::span<const ViewFacts> views, const StopParameters& parameters) {
  const auto window = static_cast<std::size_t>(parameters.stop_window_views);
  const double before = views[views.size() - window - 1].mean_quality;
  return views.back().mean_quality - before < parameters.stop_improvement;
}

}  // namespace

std::span<const StopReason> all_stop_reasons() { return kStopReasons; }

std::string_view to_string(StopReason reason) {
  switch (reason) {
    case StopReason::NothingLeft:
      return "nothing_left";
    case StopReason::NothingNew:
      return "nothing_new";
    case StopReason::QualityReached:
      return "quality_reached";
    case StopReason::NoImprovement:
      return "no_improvement";
    case StopReason::ViewLimit:
      return "view_limit";
    case StopReason::NoFeasibleGoal:
      return "no_feasible_goal";
    case StopReason::DigestMismatch:
      return "digest_mismatch";
    case StopReason::NoAnswer:
      return "no_answer";
    case StopReason::ProcessDied:
      return "process_died";
    case StopReason::BusFailed:
      return "bus_failed";
    case StopReason::Interrupted:
      return "interrupted";
  }
  throw std::invalid_argument("not a stop reason");
}

std::optional<StopReason> stop_reason_from_string(std::string_view name) {
  for (const StopReason reason : kStopReasons) {
    if (to_string(reason) == name) return reason;
  }
  return std::nullopt;
}

std::string_view describe(StopReason reason) {
  switch (reason) {
    case StopReason::NothingLeft:
      return "From nowhere that can be reached anything new is to be seen.";
    case StopReason::NothingNew:
      return "No more unseen area is covered.";
    case StopReason::QualityReached:
      return "No more unseen area is covered, and every voxel's quality is above the threshold.";
    case StopReason::NoImprovement:
      return "No more unseen area is covered, and quality improves no more.";
    case StopReason::ViewLimit:
      return "As many views as asked for have been taken.";
    case StopReason::NoFeasibleGoal:
      return "No attempt gave a goal that the base could reach.";
    case StopReason::DigestMismatch:
      return "The planner and the mapper made different maps of the same range images.";
    case StopReason::NoAnswer:
      return "A process did not answer, however often it was asked.";
    case StopReason::ProcessDied:
      return "A process ended before the run did.";
    case StopReason::BusFailed:
      return "The bus broke down.";
    case StopReason::Interrupted:
      return "The run was interrupted by a signal.";
  }
  throw std::invalid_argument("not a stop reason");
}

std::span<const StopRule> all_stop_rules() { return kStopRules; }

std::string_view to_string(StopRule rule) {
  switch (rule) {
    case StopRule::NothingNew:
      return "nothing_new";
    case StopRule::Quality:
      return "quality";
    case StopRule::NoImprovement:
      return "no_improvement";
  }
  throw std::invalid_argument("not a stop rule");
}

std::optional<StopRule> stop_rule_from_string(std::string_view name) {
  for (const StopRule rule : kStopRules) {
    if (to_string(rule) == name) return rule;
  }
  return std::nullopt;
}

void StopParameters::check() const {
  to_string(rule);
  bounds::kQualityThreshold.require(quality_threshold);
  bounds::kStopWindow.require(stop_window_views);
  bounds::kStopNewArea.require(stop_new_area_m2);
  bounds::kStopImprovement.require(stop_improvement);
}

ViewFacts view_facts(const FoldReport& report, const MapStatistics& after, double voxel_size_m) {
  return {static_cast<double>(report.newly_occupied) * voxel_size_m * voxel_size_m,
          after.min_quality, after.mean_quality};
}

std::optional<StopReason> should_stop(std::span<const ViewFacts> views,
                                      const StopParameters& parameters) {
  if (!nothing_new(views, parameters)) return std::nullopt;
  switch (parameters.rule) {
    case StopRule::NothingNew:
      return StopReason::NothingNew;
    case StopRule::Quality:
      if (views.back().min_quality < parameters.quality_threshold) return std::nullopt;
      return StopReason::QualityReached;
    case StopRule::NoImprovement:
      if (!no_improvement(views, parameters)) return std::nullopt;
      return StopReason::NoImprovement;
  }
  throw std::invalid_argument("not a stop rule");
}

}  // namespace nextview
