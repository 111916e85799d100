#include "lcmtypes/early_messages.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace nextview {

bool EarlyMessages::keep(Message message) {
  const auto same = [&message](const Message& other) {
    return other.key == message.key && other.channel == message.channel &&
           other.bytes == message.bytes;
  };
  if (std::ranges::any_of(messages_, same)) return true;
  if (messages_.size() >= kMost || bytes_ + message.bytes.size() > kMostBytes) return false;
  bytes_ += message.bytes.size();
  messages_.push_back(std::move(message));
  return true;
}

bool EarlyMessages::wait_for(std::string_view channel) const {
  return std::ranges::any_of(
      messages_, [channel](const Message& message) { return message.waits_for == channel; });
}

std::vector<EarlyMessages::Message> EarlyMessages::take_all() {
  bytes_ = 0;
  return std::exchange(messages_, {});
}

std::vector<EarlyMessages::Message> EarlyMessages::take_stale(Clock::time_point now) {
  const auto stale = std::stable_partition(
      messages_.begin(), messages_.end(),
      [now](const Message& message) { return now - message.since < kLongest; });
  std::vector<Message> taken(std::make_move_iterator(stale),
                             std::make_move_iterator(messages_.end()));
  messages_.erase(stale, messages_.end());
  for (const Message& message : taken) bytes_ -= message.bytes.size();
  return taken;
}

}  // namespace nextview
