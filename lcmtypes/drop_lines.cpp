#include "lcmtypes/drop_lines.h"

#include <algorithm>
#include <ostream>

namespace nextview {

void DropLines::say(std::string_view channel, std::string_view reason, std::int64_t count,
                    Clock::time_point now) {
  if (!may_speak(now)) {
    unsaid_[std::string(channel)] += count;
    return;
  }
  tell_sum();
  *out_ << role_ << ": dropped ";
  if (count == 1) {
    *out_ << "a message";
  } else {
    *out_ << count << " messages";
  }
  if (!channel.empty()) *out_ << " on " << channel;
  *out_ << ": " << reason << std::endl;
}

void DropLines::tell_sum_when_due(Clock::time_point now) {
  if (!unsaid_.empty() && may_speak(now)) tell_sum();
}

bool DropLines::may_speak(Clock::time_point now) {
  if (const auto earned = (now - counted_from_) / kAfterwards; earned > 0) {
    lines_ = static_cast<int>(std::min<std::int64_t>(lines_ + earned, kAtOnce));
    counted_from_ = now;
  }
  if (lines_ == 0) return false;
  --lines_;
  return true;
}

void DropLines::tell_sum() {
  if (unsaid_.empty()) return;
  *out_ << role_ << ": dropped more like these:";
  const char* before = " ";
  for (const auto& [channel, count] : unsaid_) {
    *out_ << before << count << (channel.empty() ? "" : " on ") << channel;
    before = ", ";
  }
  *out_ << std::endl;
  unsaid_.clear();
}

}  // namespace nextview
