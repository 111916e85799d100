#include "runner/run_processes.h"

#include <signal.h>

#include <system_error>
#include <utility>

#include "runner/run_setup.h"

namespace nextview {
namespace {

constexpr double kPatience_s = 2.0;

}  // namespace

std::vector<std::string> answering_roles(const std::vector<std::string>& without) {
  std::vector<std::string> roles = {"base_sim", "sensor_sim", "mapper"};
  for (const std::string& role : without) std::erase(roles, role);
  return roles;
}

RunProcesses::RunProcesses(std::string lcm_url, std::int64_t run, const std::filesystem::path& log,
                           const std::vector<std::string>& answering,
                           const std::vector<std::string>& mapper_options)
    : lcm_url_(std::move(lcm_url)), run_(run) {
  const auto recorder = find_in_path("lcm-logger");
  if (!recorder) {
    throw SetupError("lcm-logger is not in PATH: type apt-get install liblcm-bin");
  }
  // Written out with every message that comes a millisecond after the one before: what is read back
  // at the end must be there.
  try {
    children_.emplace_back("lcm-logger",
                           std::vector<std::string>{*recorder, "--quiet", "--flush-interval=1",
                                                    "--lcm-url=" + lcm_url_, log.string()},
                           AtParentsDeath::Terminate);
  } catch (const std::system_error& error) {
    throw SetupError(error.what());
  }
  for (const std::string& role : answering) {
    start(role, role == "mapper" ? mapper_options : std::vector<std::string>());
  }
}

void RunProcesses::start_planner(const std::filesystem::path& program) {
  if (program.empty()) {
    start("planner");
    return;
  }
  try {
    start("planner", std::filesystem::absolute(program));
  } catch (const std::system_error& error) {
    throw SetupError(std::string("--planner: ") + error.what() +
                     ": name a program that can be run");
  }
}

void RunProcesses::start(const std::string& role, const std::vector<std::string>& options) {
  const auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  try {
    start(role, folder / ("nextview_" + role), options);
  } catch (const std::system_error& error) {
    throw SetupError(std::string(error.what()) + ": build nextview again");
  }
}

void RunProcesses::start(const std::string& role, const std::filesystem::path& program,
                         const std::vector<std::string>& options) {
  std::vector<std::string> command = {program.string(), "--lcm-url=" + lcm_url_,
                                      "--run=" + std::to_string(run_)};
  command.insert(command.end(), options.begin(), options.end());
  children_.emplace_back(role, command, AtParentsDeath::Kill);
}

std::optional<std::string> RunProcesses::casualty() {
  for (ChildProcess& child : children_) {
    if (child.running()) continue;
    std::string text = child.role() + " " + child.how_it_ended();
    for (const std::string& line : child.last_lines()) text += "\n  " + line;
    return text;
  }
  return std::nullopt;
}

std::vector<std::string> RunProcesses::take_lines() {
  std::vector<std::string> lines;
  for (ChildProcess& child : children_) {
    for (const std::string& line : child.take_lines()) lines.push_back(child.role() + ": " + line);
  }
  return lines;
}

void RunProcesses::end_planner() {
  for (ChildProcess& child : children_) {
    if (child.role() == "planner") child.terminate(kPatience_s);
  }
}

void RunProcesses::end_all() {
  for (std::size_t i = 1; i < children_.size(); ++i) children_[i].signal(SIGTERM);
  for (std::size_t i = 1; i < children_.size(); ++i) children_[i].terminate(kPatience_s);
  children_[0].terminate(kPatience_s);
}

std::map<std::string, std::int64_t> RunProcesses::peak_memory_bytes() const {
  std::map<std::string, std::int64_t> bytes;
  for (const ChildProcess& child : children_) bytes[child.role()] = child.peak_memory_bytes();
  return bytes;
}

}  // namespace nextview
