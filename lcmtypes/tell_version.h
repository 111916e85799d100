#pragma once

#include <filesystem>
#include <iostream>
#include <string>

#include "lcmtypes/program_version.h"

namespace nextview {

/// For programs that read no options by CLI11: when --version is all that was typed, prints name
/// and version as the others do.
/// @return whether it was, and the program has nothing more to do
inline bool tell_version(int argc, char** argv) {
  if (argc != 2 || std::string(argv[1]) != "--version") return false;
  const std::string name = std::filesystem::path(argv[0]).filename();
  std::cout << name << ' ' << program_version() << '\n';
  return true;
}

}  // namespace nextview
