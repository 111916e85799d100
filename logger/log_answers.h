#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "lcmtypes/bus.h"
#include "logger/log_reader.h"

namespace nextview {

/// Answers for views whose publishers need not keep them any more, out of the log in which all of
/// them is.
class LogAnswers {
 public:
  /// @throws LogError when the log cannot be opened
  explicit LogAnswers(const std::filesystem::path& log) : reader_(log) {}

  /// All of the next view lies between these two positions of the log.
  void add_view(std::int64_t begin, std::int64_t end) { places_.push_back({begin, end}); }
  int views() const { return static_cast<int>(places_.size()); }

  /// Publishes what is asked for once more, byte for byte, if it is of one of these views.
  void answer(Bus& bus, const request_t& request);

 private:
  struct Place {
    std::int64_t begin;
    std::int64_t end;
  };

  LogReader reader_;
  std::vector<Place> places_;  // of view 1, 2, ...
};

}  // namespace nextview
