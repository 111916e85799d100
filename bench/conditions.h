#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mapper/voxel_map.h"

namespace nextview {

/// What one call of the benchmark program measures.
struct BenchOptions {
  bool quick = false;  ///< 10 and 5 cm only, fewer views
  std::vector<double> voxel_sizes_m() const {
    return quick ? std::vector<double>{0.10, 0.05} : std::vector<double>{0.10, 0.05, 0.02};
  }
};

/// Writes what the figures depend on into the JSON's context: processor, instruction set in use,
/// compiler, flags, library versions.
void report_conditions();

/// Writes one fact about a setting into the context and tells the user.
void report_condition(const std::string& name, const std::string& value);

/// Two ways of doing the same, compared answer by answer before anything is timed.
class Agreement {
 public:
  /// @param pair what is compared, such as "view_evaluation/5cm nextview = plain"
  explicit Agreement(std::string pair) : pair_(std::move(pair)) {}
  void compare(bool same) {
    ++compared_;
    differ_ += same ? 0 : 1;
  }
  /// Writes the share that differs into the context, to stand beside the figures.
  void report(const std::string& of_what, const std::string& remark = "") const;
  /// The same, and ends the program unless every answer was the same.
  void report_and_require_none(const std::string& of_what) const;

 private:
  std::string pair_;
  std::int64_t compared_ = 0;
  std::int64_t differ_ = 0;
};

}  // namespace nextview
