#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "lcmtypes/ask_timer.h"
#include "lcmtypes/channels.h"

namespace nextview {

/// Messages that have to come before others can be judged. They are asked for again and again, as
/// question and answer may both be lost, until they have come, or for so long that there can be
/// none.
class WantedMessages {
 public:
  using Clock = std::chrono::steady_clock;
  /// So many are remembered; strangers can make up as many as they like.
  static constexpr std::size_t kMost = 64;
  static constexpr std::chrono::seconds kLongest{20};

  struct Wanted {
    std::string channel;
    int view;
    int attempt;  ///< 0: all there are
    bool operator==(const Wanted& other) const = default;
  };

  /// Notes that a message is wanted.
  /// @param for_whom the message that cannot be judged before
  /// @param answer_time how long answers take
  /// @return whether to ask for it now: it is not being asked for already, or that message has come
  ///         once more, so that somebody waits for this one
  bool want(const Wanted& wanted, const MessageKey& for_whom,
            std::chrono::milliseconds answer_time);
  /// One has come.
  void came(std::string_view channel, const MessageKey& key);
  /// Those to be asked for again now.
  std::vector<Wanted> take_due();
  bool empty() const { return asked_.empty(); }

 private:
  struct Asked {
    Wanted wanted;
    MessageKey for_whom;
    AskTimer timer;
    Clock::time_point since;
  };
  std::vector<Asked> asked_;
};

}  // namespace nextview
