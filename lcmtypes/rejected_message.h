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

/// Thrown by a handler that cannot judge a message yet, as what must have led to it has not been
/// heard. The bus asks for that, and hands the message over again when it has come.
class TooEarly : public std::runtime_error {
 public:
  /// @param reason what has not been heard, in words
  /// @param channel on which it is asked for, with the view and the attempt (0: all there are)
  TooEarly(const std::string& reason, std::string_view channel, int view, int attempt)
      : std::runtime_error(reason), channel_(channel), view_(view), attempt_(attempt) {}
  std::string_view channel() const { return channel_; }
  int view() const { return view_; }
  int attempt() const { return attempt_; }

 private:
  std::string_view channel_;  // of the channel table
  int view_;
  int attempt_;
};

/// Thrown by a handler that has no use for a message at present and is to be given it again when it
/// comes again.
class NotNow : public std::exception {};

/// Whether a run can have an attempt of a view.
/// @throws RejectedMessage when it cannot
void check_fits_run(const run_config_t& config, std::int32_t view, std::int32_t attempt);

}  // namespace nextview
