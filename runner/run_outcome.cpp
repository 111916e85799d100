#include "runner/run_outcome.h"

#include <fmt/format.h>

#include "base_sim/base.h"

namespace nextview {
namespace {

void take_end(const stop_t& stop, FinishedRun& run) {
  run.stop_reason = stop.stop_reason;
  run.stop_detail = stop.detail;
  if (stop_reason_from_string(run.stop_reason)) return;
  run.stop_detail = fmt::format(
      "The run was ended for the reason \"{}\", which this version of nextview_run does not know: "
      "start it with the planner it was built with. {}",
      stop.stop_reason, stop.detail);
}

}  // namespace

void count_refusals(const RunRecord& record, FinishedRun& run) {
  for (const auto& [key, arrival] : record.arrivals()) {
    if (arrival.arrived) continue;
    ++(arrival.refusal.starts_with(kCollision) ? run.collisions : run.other_refusals);
  }
}

void tell_end(const RunRecord& record, const std::optional<EndsEarly>& early, FinishedRun& run) {
  const std::optional<stop_t>& stop = record.stop();
  if (!early) {
    take_end(*stop, run);
    return;
  }
  run.stop_reason = to_string(early->reason);
  run.stop_detail = early->detail;
  if (stop && stop->stop_reason != run.stop_reason) {
    run.stop_detail +=
        fmt::format(" (the planner had ended the run by then: {})", stop->stop_reason);
  }
}

}  // namespace nextview
