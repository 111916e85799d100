#include "tests/exporter/exported.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

namespace nextview {

std::filesystem::path short_log() {
  return std::filesystem::path(NEXTVIEW_SOURCE_DIR) / "tests/logger/fixtures/surface-1.lcmlog";
}

std::filesystem::path exported(const TemporaryFolder& folder, const std::string& format,
                               const std::filesystem::path& log,
                               const std::vector<std::string>& more) {
  const std::filesystem::path file = folder / format;
  std::vector<std::string> arguments = {
      program_path("nextview_export"), log.string(), "--to", format, "--out", file.string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Outcome outcome = run_program(arguments);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  return file;
}

std::string program_of_system(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "/usr/bin" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::filesystem::path program = std::filesystem::path(folder) / name;
    if (std::filesystem::exists(program)) return program.string();
  }
  return {};
}

Said say(const std::vector<std::string>& arguments) {
  const Outcome outcome = run_program(arguments);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  Said said;
  std::istringstream lines(outcome.output);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string name;
    words >> name;
    for (std::string word; words >> word;) said[name].push_back(word);
  }
  return said;
}

}  // namespace nextview
