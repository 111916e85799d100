#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "logger/run_record.h"

namespace nextview {

/// Fields that a replay takes as they are, and why.
struct UncheckedFields {
  std::string_view why;
  std::string_view channel;
  std::vector<std::string> fields;  ///< by the names of message_fields.h
};

/// What a replay of a run leaves unchecked: neither compared nor worked out again. Whether it is
/// what was recorded only the log's seal tells. A type of message that a replay does not look at is
/// among them with all its fields, without being named here.
/// @param run with its configuration
/// @param planner whether it decides every goal again
std::vector<UncheckedFields> unchecked_fields(const RunRecord& run, bool planner);

/// Whether a field is among them.
bool is_unchecked(std::span<const UncheckedFields> unchecked, std::string_view channel,
                  const std::string& field);

}  // namespace nextview
