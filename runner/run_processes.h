#pragma once

#include <cstdint>
#include <filesystem>
#include <list>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runner/child_process.h"

namespace nextview {

/// Roles of the processes that answer the planner, in the order in which they do, but for those
/// that a driver stands in for.
std::vector<std::string> answering_roles(const std::vector<std::string>& without);

/// A process that has ended though it should not have.
struct Casualty {
  std::string role;
  std::string account;  ///< its role, how it ended, and its last words
};

/// Options of processes, of no influence on results, by role.
using RoleOptions = std::map<std::string, std::vector<std::string>>;

/// The processes of a run and its recorder.
class RunProcesses {
 public:
  static constexpr const char* kRecorder = "lcm-logger";
  static constexpr const char* kPlanner = "planner";

  /// Starts lcm-logger, which must be in PATH, and the processes that answer the planner, which lie
  /// beside this program's own executable.
  /// @param answering their roles
  /// @param reached the view the run has got to already, up to which they catch up; 0: it begins
  /// @param folder_lock a file descriptor that the recorder holds open until its end
  /// @param options that processes are started with, by role
  /// @throws SetupError saying what cannot be started and what to do
  RunProcesses(std::string lcm_url, std::int64_t run, const std::filesystem::path& log,
               const std::vector<std::string>& answering, int reached, int folder_lock,
               RoleOptions options = {});

  /// Starts the planner, and with it the run: when the others are ready, so that its first goal
  /// need not be asked for again.
  /// @param program a planner of the user's own, that begins anew; empty: nextview_planner
  /// @param reached as above
  /// @throws SetupError likewise
  void start_planner(const std::filesystem::path& program, int reached);

  /// Who has ended though it should not have; nothing when all run.
  std::optional<Casualty> casualty();
  /// Starts another process in the place of one that has ended. The recorder goes on with its log,
  /// which must end on a whole message.
  /// @param reached the view the run has got to, up to which the new one catches up
  /// @throws SetupError as above
  void restart(const std::string& role, int reached);
  /// Whether the planner is the user's own, of which nobody knows whether it would say the same.
  bool has_own_planner() const { return !own_planner_.empty(); }
  /// What to type to start a process by hand, on a host that has nextview in its PATH.
  std::string command_of(const std::string& role, int reached) const;
  /// What the processes have said on stderr since the last call, each line with its role.
  std::vector<std::string> take_lines();

  /// Ends the planner, so that no new goal comes.
  void end_planner();
  /// Ends the processes, and then the recorder, which writes out all it has.
  void end_all();

  /// Most memory each ever held, by role.
  std::map<std::string, std::int64_t> peak_memory_bytes() const;

 private:
  using Children = std::list<ChildProcess>;  // whose places do not change

  void start_recorder(Children::const_iterator before);
  void start(const std::string& role, int reached, Children::const_iterator before);
  std::vector<std::string> arguments_of(const std::string& role, int reached) const;
  std::filesystem::path program_of(const std::string& role) const;
  Children::iterator child(const std::string& role);

  std::string lcm_url_;
  std::int64_t run_;
  std::filesystem::path log_;
  std::filesystem::path own_planner_;
  int folder_lock_;
  RoleOptions options_;
  int nice_value_;     ///< of this process before it gives way to them
  Children children_;  // the recorder first, the planner last
  std::map<std::string, std::int64_t> memory_of_ended_;  ///< of those others stand in for
};

}  // namespace nextview
