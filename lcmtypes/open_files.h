#pragma once

#include <string>

namespace nextview {

constexpr int kOpenFilesOfRun = 64;      ///< what a run takes at most, its recorder included
constexpr int kOpenFilesOfProcess = 24;  ///< what one process on the bus takes at most

/// Lets this process, and those it starts, have so many open files, as far as the system allows.
/// @return why it does not, and what to type; empty when there are enough
std::string too_few_open_files(int wanted);

}  // namespace nextview
