#pragma once

#include <sys/resource.h>
#include <sys/types.h>

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "runner/file_descriptor.h"

namespace nextview {

/// What the kernel sends a child when this process ends, however it ends.
enum class AtParentsDeath { Kill, Terminate };

/// What a child gets of this process.
struct ChildTerms {
  AtParentsDeath at_death = AtParentsDeath::Kill;
  int kept_open = -1;             ///< a file descriptor that it holds open until its end; -1: none
  std::optional<int> nice_value;  ///< if this process may give it; else, and without, its own
};

/// A program started by this one, that cannot outlive it and whose words on stderr are kept.
///
/// It runs in a process group of its own, so that Ctrl-C in a terminal reaches only this program,
/// which then ends the children in order. Its stdin is empty and its stdout goes where its stderr
/// does.
class ChildProcess {
 public:
  /// @param role what to call it in messages
  /// @param arguments the program, looked up in PATH unless it has a slash, and its arguments
  /// @throws std::system_error when it cannot be started (no such program, say)
  ChildProcess(std::string role, const std::vector<std::string>& arguments,
               const ChildTerms& terms = {});
  ChildProcess(ChildProcess&&) noexcept = default;
  ChildProcess& operator=(ChildProcess&&) = delete;
  /// Kills it if it still runs.
  ~ChildProcess();

  const std::string& role() const { return role_; }
  pid_t pid() const { return pid_; }

  /// Looks, without waiting, whether it still runs, and takes in what it said.
  bool running();
  /// Sends a signal, if it still runs.
  void signal(int number);
  /// Sends SIGTERM, waits for its end up to a limit, then sends SIGKILL.
  void terminate(double patience_s);

  /// Lines it has said since the last call.
  std::vector<std::string> take_lines();
  /// The last few lines it has said.
  const std::deque<std::string>& last_lines() const { return last_lines_; }

  /// After its end: "was killed by signal 9 (Killed)" or "ended with status 1".
  std::string how_it_ended() const;
  /// After its end: the exit status, or nothing when a signal ended it.
  std::optional<int> exit_status() const;
  /// Most memory it ever held, resident: exact after its end, from /proc before.
  std::int64_t peak_memory_bytes() const;

 private:
  void read_output();
  void add_line(std::string line);

  std::string role_;
  pid_t pid_ = -1;
  FileDescriptor output_;
  std::string partial_line_;
  std::vector<std::string> new_lines_;
  std::deque<std::string> last_lines_;
  std::optional<int> wait_status_;
  rusage usage_{};
};

/// A program's path as execvp would find it, or nothing.
std::optional<std::string> find_in_path(const std::string& program);

}  // namespace nextview
