#include "tests/system/program.h"

#include <poll.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "runner/file_descriptor.h"

namespace nextview {
namespace {

FileDescriptor handle_of(pid_t pid) {
  return FileDescriptor(static_cast<int>(::syscall(SYS_pidfd_open, pid, 0)));
}

std::string name_of(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/cmdline");
  std::string program;
  std::getline(file, program, '\0');
  return std::filesystem::path(program).filename();
}

}  // namespace

Program::Program(const std::vector<std::string>& arguments) : process_("program", arguments) {}

bool Program::take_in() {
  const bool running = process_.running();
  for (const std::string& line : process_.take_lines()) output_ += line + "\n";
  return running;
}

bool Program::wait_for(const std::string& text) {
  const FileDescriptor handle = handle_of(process_.pid());
  bool running = true;
  while (running) {
    running = take_in();
    if (output_.find(text) != std::string::npos) return true;
    pollfd end{handle.get(), POLLIN, 0};
    ::poll(&end, 1, 2);
  }
  return false;
}

int Program::wait() {
  const FileDescriptor handle = handle_of(process_.pid());
  while (take_in()) {
    pollfd end{handle.get(), POLLIN, 0};
    ::poll(&end, 1, 10);
  }
  return process_.exit_status().value_or(128);
}

std::vector<pid_t> Program::children() const {
  const std::string id = std::to_string(pid());
  std::ifstream file("/proc/" + id + "/task/" + id + "/children");
  return {std::istream_iterator<pid_t>(file), {}};
}

pid_t Program::child(const std::string& name) const {
  for (const pid_t pid : children()) {
    if (name_of(pid) == name || name_of(pid) == "nextview_" + name) return pid;
  }
  return 0;
}

std::string program_path(const std::string& name) {
  return (std::filesystem::path(NEXTVIEW_PROGRAMS_FOLDER) / name).string();
}

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "nextview-test-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("mkdtemp " + pattern);
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

Outcome run_program(const std::vector<std::string>& arguments) {
  Program program(arguments);
  const int status = program.wait();
  return {status, program.output()};
}

std::vector<std::string> run_arguments(const std::filesystem::path& folder, int views,
                                       const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {program_path("nextview_run"), "--out", folder.string(),
                                        "--views", std::to_string(views)};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

Outcome run_views(const std::filesystem::path& folder, int views,
                  const std::vector<std::string>& more) {
  return run_program(run_arguments(folder, views, more));
}

Outcome replay_folder(const std::filesystem::path& folder, const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {program_path("nextview_replay"), folder.string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_program(arguments);
}

std::vector<std::string> column_of_views(const std::filesystem::path& folder,
                                         const std::string& heading) {
  std::ifstream file(folder / "views.csv");
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(file, line);) {
    std::istringstream cells(line + ',');  // the last cell may be empty
    std::vector<std::string>& row = rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
  }
  if (rows.empty()) throw std::runtime_error(folder.string() + " has no views.csv");
  const auto found = std::find(rows[0].begin(), rows[0].end(), heading);
  if (found == rows[0].end()) throw std::runtime_error("views.csv has no column " + heading);
  const auto column = static_cast<std::size_t>(found - rows[0].begin());
  std::vector<std::string> values;
  for (std::size_t i = 1; i < rows.size(); ++i) values.push_back(rows[i].at(column));
  return values;
}

nlohmann::json summary_of(const std::filesystem::path& folder) {
  std::ifstream file(folder / "summary.json");
  return nlohmann::json::parse(file);
}

void wait_until_gone(pid_t pid) {
  const FileDescriptor handle = handle_of(pid);
  if (!handle) return;  // gone already
  pollfd end{handle.get(), POLLIN, 0};
  ::poll(&end, 1, -1);
}

}  // namespace nextview
