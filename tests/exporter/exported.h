#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/system/program.h"

namespace nextview {

/// The log of a short run with a coarse sensor, in view of a whole room.
std::filesystem::path short_log();

/// The file nextview_export makes of a log; the test fails when it does not.
std::filesystem::path exported(const TemporaryFolder& folder, const std::string& format,
                               const std::filesystem::path& log = short_log(),
                               const std::vector<std::string>& more = {});

/// Where a program of the system is, or nothing.
std::string program_of_system(const std::string& name);

/// What a program of the system says in lines "name value value ...", by the name.
using Said = std::map<std::string, std::vector<std::string>>;
Said say(const std::vector<std::string>& arguments);

}  // namespace nextview

/// Leaves a test out, and says so, where a program is not installed.
#define NEXTVIEW_NEEDS_PROGRAM(name, package)                                  \
  if (nextview::program_of_system(name).empty()) {                             \
    GTEST_SKIP() << "needs " << (name) << " of Debian's package " << (package) \
                 << " to read the file back: apt-get install " << (package);   \
  }
