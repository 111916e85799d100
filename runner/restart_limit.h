#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace nextview {

/// How often a process that has ended is started again: a few times, and anew once the run has got
/// on. One that meets the same end each time does not get on.
class RestartLimit {
 public:
  /// Times without the run getting on in between.
  static constexpr int kTries = 3;

  /// Notes that a process has ended.
  /// @param progress how far the run has come, in whatever unit; never falls
  /// @return whether to start it again
  bool allows(const std::string& role, std::int64_t progress);

 private:
  struct Tries {
    std::int64_t progress = 0;  ///< at the last end
    int count = 0;
  };
  std::map<std::string, Tries> tries_;  // by role
};

}  // namespace nextview
