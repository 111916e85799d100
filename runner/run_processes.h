#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runner/child_process.h"

namespace nextview {

/// Roles of the processes that answer the planner, in the order in which they do, but for those
/// that a driver stands in for.
std::vector<std::string> answering_roles(const std::vector<std::string>& without);

/// The processes of a run and its recorder.
class RunProcesses {
 public:
  /// Starts lcm-logger, which must be in PATH, and the processes that answer the planner, which lie
  /// beside this program's own executable.
  /// @param answering their roles
  /// @param mapper_options that nextview_mapper is started with
  /// @throws SetupError saying what cannot be started and what to do
  RunProcesses(std::string lcm_url, std::int64_t run, const std::filesystem::path& log,
               const std::vector<std::string>& answering,
               const std::vector<std::string>& mapper_options = {});

  /// Starts the planner, and with it the run: when the others are ready, so that its first goal
  /// need not be asked for again.
  /// @param program a planner of the user's own; empty: nextview_planner
  /// @throws SetupError likewise
  void start_planner(const std::filesystem::path& program);

  /// Who has ended though it should not have, how, and its last words; nothing when all run.
  std::optional<std::string> casualty();
  /// What the processes have said on stderr since the last call, each line with its role.
  std::vector<std::string> take_lines();

  /// Ends the planner, so that no new goal comes.
  void end_planner();
  /// Ends the processes, and then the recorder, which writes out all it has.
  void end_all();

  /// Most memory each ever held, by role.
  std::map<std::string, std::int64_t> peak_memory_bytes() const;

 private:
  void start(const std::string& role, const std::vector<std::string>& options = {});
  void start(const std::string& role, const std::filesystem::path& program,
             const std::vector<std::string>& options = {});

  std::string lcm_url_;
  std::int64_t run_;
  std::vector<ChildProcess> children_;  // the recorder first, the planner last
};

}  // namespace nextview
