#include "lcmtypes/wanted_messages.h"

#include <algorithm>

namespace nextview {

bool WantedMessages::want(const Wanted& wanted, const MessageKey& for_whom,
                          std::chrono::milliseconds answer_time) {
  constexpr std::chrono::milliseconds kLongestWait{500};
  const auto asked = std::ranges::find(asked_, wanted, &Asked::wanted);
  if (asked != asked_.end()) return asked->for_whom == for_whom;
  if (asked_.size() < kMost) {
    asked_.push_back({wanted, for_whom, AskTimer(answer_time, kLongestWait), Clock::now()});
  }
  return true;
}

void WantedMessages::came(std::string_view channel, const MessageKey& key) {
  std::erase_if(asked_, [&](const Asked& asked) {
    const Wanted& wanted = asked.wanted;
    return wanted.channel == channel && wanted.view == key.view &&
           (wanted.attempt == 0 || wanted.attempt == key.attempt);
  });
}

std::vector<WantedMessages::Wanted> WantedMessages::take_due() {
  if (asked_.empty()) return {};
  const auto now = Clock::now();
  std::erase_if(asked_, [now](const Asked& asked) { return now - asked.since > kLongest; });
  std::vector<Wanted> due;
  for (Asked& asked : asked_) {
    if (asked.timer.due()) due.push_back(asked.wanted);
  }
  return due;
}

}  // namespace nextview
