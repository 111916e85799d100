#pragma once

#include <cstdint>
#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>

#include "lcmtypes/channels.h"

namespace nextview {

/// Thrown by a handler that finds a well-formed message impossible in its run (an unknown view,
/// say) and has ignored it. The bus then drops it like any other message that cannot be right.
class RejectedMessage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Thrown by a handler that finds that what must have led to a message has not been heard. The bus
/// asks for that until it comes. Then the message is asked for, too: one said before anybody could
/// have said it may not stand in the way of the true one.
class TooEarly : public std::runtime_error {
 public:
  /// What becomes of the message when what led to it has come.
  enum class Then {
    AskAnew,
    JudgeAgain,  ///< kept until then: what is large, and can be held against what led to it
    Forget,      ///< whoever threw asks for it, when he knows that he lacks it
  };
  /// @param reason what has not been heard, in words
  /// @param channel on which it is asked for, with the view and the attempt (0: all there are)
  TooEarly(const std::string& reason, std::string_view channel, int view, int attempt,
           Then then = Then::AskAnew)
      : std::runtime_error(reason),
        channel_(channel),
        view_(view),
        attempt_(attempt),
        then_(then) {}
  Then then() const { return then_; }
  std::string_view channel() const { return channel_; }
  int view() const { return view_; }
  int attempt() const { return attempt_; }

 private:
  std::string_view channel_;  // of the channel table
  int view_;
  int attempt_;
  Then then_;
};

/// Thrown by a handler that has no use for a message at present and is to be given it again when it
/// comes again.
class NotNow : public std::exception {};

/// Whether a run can have an attempt of a view.
/// @throws RejectedMessage when it cannot
void check_fits_run(const run_config_t& config, std::int32_t view, std::int32_t attempt);

}  // namespace nextview
