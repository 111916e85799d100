#pragma once

#include <string>

#include "planner/termination.h"

namespace nextview {

/// Thrown when a run cannot go on to its own end.
struct EndsEarly {
  StopReason reason;
  std::string detail;
};

}  // namespace nextview
