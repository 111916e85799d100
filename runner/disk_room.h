#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace nextview {

/// Why a file, such as a log, can take no further message: no room on its disk, the largest size a
/// file may have here (ulimit -f), no right, no folder any more. Tried by writing as much as a
/// message may have into another file of its folder, which is removed again.
/// @return in words, as the system has it; nothing when it can
std::optional<std::string> why_no_more_fits(const std::filesystem::path& file);

}  // namespace nextview
