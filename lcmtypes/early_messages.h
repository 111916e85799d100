#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lcmtypes/channels.h"

namespace nextview {

/// Messages for which it is too early, as what led to them has not been heard: kept a while, up to
/// a bound, until it has; or only their keys, when they are to be asked for anew then.
class EarlyMessages {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kMost = 2048;
  static constexpr std::size_t kMostBytes = 8u << 20;
  /// What led to a message comes sooner, however often it has to be asked for; or nothing did.
  static constexpr std::chrono::seconds kLongest{20};

  struct Message {
    std::string channel;
    MessageKey key;
    std::vector<std::uint8_t> bytes;  ///< none: to be asked for anew
    std::string waits_for;            ///< the channel of what led to it
    std::string reason;               ///< in words
    Clock::time_point since;
  };

  /// Whether it is kept; false when there is no room. One that is here already is not kept twice.
  bool keep(Message message);
  /// Whether one of them waits for something on a channel.
  bool wait_for(std::string_view channel) const;
  /// All of them, to be judged again; they are here no more.
  std::vector<Message> take_all();
  /// Those for which nothing has come in all the time there was; they are here no more.
  std::vector<Message> take_stale(Clock::time_point now);
  bool empty() const { return messages_.empty(); }

 private:
  std::vector<Message> messages_;
  std::size_t bytes_ = 0;
};

}  // namespace nextview
