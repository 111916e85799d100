#include "runner/exit_status.h"

#include <stdexcept>

namespace nextview {

int exit_status(StopReason reason) {
  switch (reason) {
    case StopReason::NothingLeft:
    case StopReason::NothingNew:
    case StopReason::QualityReached:
    case StopReason::NoImprovement:
    case StopReason::ViewLimit:
      return 0;
    case StopReason::NoFeasibleGoal:
      return 3;
    case StopReason::DigestMismatch:
      return 4;
    case StopReason::NoAnswer:
      return 5;
    case StopReason::ProcessDied:
      return 6;
    case StopReason::BusFailed:
      return 7;
    case StopReason::Interrupted:
      return 130;
  }
  throw std::invalid_argument("not a stop reason");
}

int exit_status(std::string_view stop_reason) {
  const auto reason = stop_reason_from_string(stop_reason);
  return reason ? exit_status(*reason) : 1;
}

}  // namespace nextview
