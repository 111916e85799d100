#pragma once

#include <filesystem>

namespace nextview {

/// Numbers the messages of an LCM log from 0 on, in place, up to the first that is not whole. A
/// recorder that goes on with a log begins to count anew, and LCM has the numbers rise.
/// @throws LogError when the file cannot be read or changed
void number_events(const std::filesystem::path& file);

}  // namespace nextview
