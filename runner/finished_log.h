#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "logger/run_log.h"

namespace nextview {

/// Puts the log of a run in order that nobody writes any more: cuts off half a message that a
/// recorder has left that was killed, and seals it.
/// @param file it is read from
/// @param began_anew whether more than one recorder wrote it: then its events are numbered anew
/// @return what is to be said of it; empty when there is nothing
std::vector<std::string> finish_log(RunLog& log, const std::filesystem::path& file,
                                    bool began_anew);

}  // namespace nextview
