#pragma once

#include <cstdint>
#include <initializer_list>
#include <string_view>

#include "lcmtypes/channels.h"

namespace nextview {

/// A duration by the clock on the wall and its name, a word of a-z, 0-9 and _.
struct NamedDuration {
  std::string_view name;
  double seconds;
};

/// How long a role worked on an attempt of a view; see timing_t.
timing_t timing_message(std::string_view role, std::int64_t utime, int view, int attempt,
                        std::initializer_list<NamedDuration> durations);

}  // namespace nextview
