#include "lcmtypes/timing_message.h"

namespace nextview {

timing_t timing_message(std::string_view role, std::int64_t utime, int view, int attempt,
                        std::initializer_list<NamedDuration> durations) {
  timing_t timing{};
  timing.utime = utime;
  timing.view = view;
  timing.attempt = attempt;
  timing.role = role;
  for (const NamedDuration& duration : durations) {
    timing.duration_s.push_back(duration.seconds);
    if (!timing.duration_names.empty()) timing.duration_names += ',';
    timing.duration_names += duration.name;
  }
  timing.durations = static_cast<std::int32_t>(timing.duration_s.size());
  return timing;
}

}  // namespace nextview
