#pragma once

#include <array>
#include <chrono>
#include <cstddef>

namespace nextview {

/// How long it takes until what is waited for comes, and with that how long to wait before asking
/// for it again.
///
/// As in TCP (RFC 6298) the wait is four times what is usual, and what was asked for twice tells
/// nothing (Karn's algorithm). Unlike there many a time is no round trip: what is waited for may
/// have been lost on its way to whoever has to work on it, and came only when that one had asked.
/// So usual is the lower quartile of the last times, and not their mean, which would make waits
/// longer by what waits have cost.
class ResponseTime {
 public:
  using Seconds = std::chrono::duration<double>;
  using milliseconds = std::chrono::milliseconds;

  static constexpr milliseconds kFirstTimeout{20};  ///< until anything is known
  static constexpr milliseconds kShortestTimeout{
      5};  ///< what a busy machine takes to wake somebody
  static constexpr milliseconds kLongestTimeout{800};

  /// Something has come after so long.
  void took(Seconds time);
  /// How long to wait before asking again.
  milliseconds timeout() const;

 private:
  static constexpr std::size_t kTimes = 16;
  std::array<Seconds, kTimes> times_{};  // the last ones, round and round
  std::size_t took_ = 0;
};

}  // namespace nextview
