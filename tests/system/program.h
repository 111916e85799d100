#pragma once

#include <sys/types.h>

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "runner/child_process.h"

namespace nextview {

/// A program of nextview's that a test has started. Its stdout and stderr come together.
class Program {
 public:
  explicit Program(const std::vector<std::string>& arguments);

  /// Waits until it has said something that contains the text; false when it ended without.
  bool wait_for(const std::string& text);
  /// Takes in what it has said, and tells whether it has not ended yet.
  bool running() { return take_in(); }
  /// Waits for its end and returns its exit status, or 128 and more when a signal ended it.
  int wait();
  void signal(int number) { process_.signal(number); }
  pid_t pid() const { return process_.pid(); }
  /// Everything it has said so far.
  const std::string& output() const { return output_; }

  /// The process it has started as nextview_ROLE, or as lcm-logger; 0 when there is none.
  pid_t child(const std::string& name) const;
  /// All processes it has started.
  std::vector<pid_t> children() const;

 private:
  bool take_in();

  ChildProcess process_;
  std::string output_;
};

/// The path of a program of the build.
std::string program_path(const std::string& name);

/// A folder that is removed with everything in it.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// What a program said and its exit status.
struct Outcome {
  int status = 0;
  std::string output;
};
Outcome run_program(const std::vector<std::string>& arguments);

/// The arguments of a run of so many views into a folder, and more.
std::vector<std::string> run_arguments(const std::filesystem::path& folder, int views,
                                       const std::vector<std::string>& more = {});
/// Such a run, carried out.
Outcome run_views(const std::filesystem::path& folder, int views,
                  const std::vector<std::string>& more = {});
Outcome replay_folder(const std::filesystem::path& folder,
                      const std::vector<std::string>& more = {});

/// A column of a run's views.csv, without its heading.
std::vector<std::string> column_of_views(const std::filesystem::path& folder,
                                         const std::string& heading);

/// What a run's summary.json says.
nlohmann::json summary_of(const std::filesystem::path& folder);

/// Waits until a process is no more.
void wait_until_gone(pid_t pid);

}  // namespace nextview
