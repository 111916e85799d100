#pragma once

#include <chrono>
#include <cstdint>
#include <iosfwd>
#include <map>
#include <string>
#include <string_view>

namespace nextview {

/// Says what has been dropped, a line each; when there is much of it, only now and then, how much
/// it was since, by channel: whoever floods the bus does not fill the screen and the disk too.
class DropLines {
 public:
  using Clock = std::chrono::steady_clock;
  /// As many lines at once, and then one in so long.
  static constexpr int kAtOnce = 10;
  static constexpr std::chrono::seconds kAfterwards{1};

  /// @param role who speaks
  DropLines(std::string role, std::ostream& out) : role_(std::move(role)), out_(&out) {}
  ~DropLines() { tell_sum(); }
  DropLines(const DropLines&) = delete;
  DropLines& operator=(const DropLines&) = delete;

  /// @param channel on which something was dropped; empty: none can be told
  /// @param count how much, for the same reason
  void say(std::string_view channel, std::string_view reason, std::int64_t count,
           Clock::time_point now);
  /// Says how much was dropped without a line, if it is time for that.
  void tell_sum_when_due(Clock::time_point now);

 private:
  bool may_speak(Clock::time_point now);
  void tell_sum();

  std::string role_;
  std::ostream* out_;
  int lines_ = kAtOnce;             // that may still be said
  Clock::time_point counted_from_;  // since when lines have been added to them
  std::map<std::string, std::int64_t, std::less<>> unsaid_;  // by channel
};

}  // namespace nextview
