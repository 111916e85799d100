#include "runner/viewer_process.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "runner/give_way.h"
#include "runner/run_setup.h"

namespace nextview {
namespace {

ChildProcess start(const std::string& lcm_url, std::int64_t run, const std::string& key_file,
                   bool paused, int listening) {
  const auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  std::vector<std::string> command = {(folder / "nextview_viewer").string(), "--attach", lcm_url,
                                      "--run", std::to_string(run)};
  if (!key_file.empty()) command.insert(command.end(), {"--key-file", key_file});
  if (paused) command.emplace_back("--paused");
  if (listening >= 0) command.emplace_back(fmt::format("--listening={}", listening));
  try {
    ChildTerms terms;
    terms.at_death = AtParentsDeath::Terminate;
    terms.nice_value = kLookingOnNice;
    terms.kept_open = listening;
    return {ViewerProcess::kRole, command, terms};
  } catch (const std::system_error& error) {
    throw SetupError(std::string("--view: ") + error.what() +
                     ": nextview_viewer needs libboost-dev where nextview is built; ./run --view "
                     "installs it");
  }
}

}  // namespace

ViewerProcess::ViewerProcess(const std::string& lcm_url, std::int64_t run,
                             const std::string& key_file, bool paused, int listening)
    : process_(start(lcm_url, run, key_file, paused, listening)) {}

bool ViewerProcess::running() { return process_.running(); }

std::vector<std::string> ViewerProcess::take_lines() {
  std::vector<std::string> lines = process_.take_lines();
  for (const std::string& line : lines) {
    if (const std::size_t at = line.find("http://"); at != std::string::npos && address_.empty()) {
      address_ = line.substr(at);
    }
  }
  if (!process_.running() && !end_told_) {
    end_told_ = true;
    lines.push_back("viewer: " + process_.how_it_ended() + "; the run goes on without it");
  }
  return lines;
}

}  // namespace nextview
