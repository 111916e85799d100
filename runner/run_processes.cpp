#include "runner/run_processes.h"

#include <signal.h>
#include <sys/resource.h>

#include <algorithm>
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
                           const std::vector<std::string>& answering, int reached, int folder_lock,
                           RoleOptions options)
    : lcm_url_(std::move(lcm_url)),
      run_(run),
      log_(log),
      folder_lock_(folder_lock),
      options_(std::move(options)),
      nice_value_(::getpriority(PRIO_PROCESS, 0)) {
  start_recorder(children_.end());
  for (const std::string& role : answering) start(role, reached, children_.end());
}

void RunProcesses::start_planner(const std::filesystem::path& program, int reached) {
  if (!program.empty()) own_planner_ = std::filesystem::absolute(program);
  start(kPlanner, reached, children_.end());
}

void RunProcesses::start_recorder(Children::const_iterator before) {
  const auto recorder = find_in_path(kRecorder);
  if (!recorder) {
    throw SetupError("lcm-logger is not in PATH: type apt-get install liblcm-bin");
  }
  // Written out with every message that comes a millisecond after the one before: what is read back
  // at the end must be there.
  std::vector<std::string> arguments = {*recorder, "--quiet", "--flush-interval=1",
                                        "--lcm-url=" + lcm_url_};
  if (std::filesystem::exists(log_)) arguments.emplace_back("--append");
  arguments.push_back(log_.string());
  try {
    children_.emplace(before, kRecorder, arguments,
                      ChildTerms{.at_death = AtParentsDeath::Terminate,
                                 .kept_open = folder_lock_,
                                 .nice_value = nice_value_});
  } catch (const std::system_error& error) {
    throw SetupError(error.what());
  }
}

void RunProcesses::start(const std::string& role, int reached, Children::const_iterator before) {
  const bool own = role == kPlanner && has_own_planner();
  try {
    children_.emplace(before, role, arguments_of(role, reached),
                      ChildTerms{.nice_value = nice_value_});
  } catch (const std::system_error& error) {
    throw SetupError(own ? std::string("--planner: ") + error.what() +
                               ": name a program that can be run"
                         : std::string(error.what()) + ": build nextview again");
  }
}

std::vector<std::string> RunProcesses::arguments_of(const std::string& role, int reached) const {
  const bool own = role == kPlanner && has_own_planner();
  std::vector<std::string> arguments = {program_of(role).string(), "--lcm-url=" + lcm_url_,
                                        "--run=" + std::to_string(run_)};
  if (reached > 0 && !own) arguments.push_back("--catch-up=" + std::to_string(reached));
  if (const auto options = options_.find(role); options != options_.end()) {
    arguments.insert(arguments.end(), options->second.begin(), options->second.end());
  }
  return arguments;
}

std::string RunProcesses::command_of(const std::string& role, int reached) const {
  std::string command = "nextview_" + role;
  const std::vector<std::string> arguments = arguments_of(role, reached);
  for (std::size_t i = 1; i < arguments.size(); ++i) command += " '" + arguments[i] + "'";
  return command;
}

std::filesystem::path RunProcesses::program_of(const std::string& role) const {
  if (role == kPlanner && has_own_planner()) return own_planner_;
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / ("nextview_" + role);
}

RunProcesses::Children::iterator RunProcesses::child(const std::string& role) {
  return std::find_if(children_.begin(), children_.end(),
                      [&role](const ChildProcess& child) { return child.role() == role; });
}

std::optional<Casualty> RunProcesses::casualty() {
  for (ChildProcess& child : children_) {
    if (child.running()) continue;
    Casualty casualty{child.role(), child.role() + " " + child.how_it_ended()};
    for (const std::string& line : child.last_lines()) casualty.account += "\n  " + line;
    return casualty;
  }
  return std::nullopt;
}

void RunProcesses::restart(const std::string& role, int reached) {
  const auto ended = child(role);
  std::int64_t& memory = memory_of_ended_[role];
  memory = std::max(memory, ended->peak_memory_bytes());
  const auto before = children_.erase(ended);
  if (role == kRecorder) {
    start_recorder(before);
  } else {
    start(role, reached, before);
  }
}

std::vector<std::string> RunProcesses::take_lines() {
  std::vector<std::string> lines;
  for (ChildProcess& child : children_) {
    for (const std::string& line : child.take_lines()) lines.push_back(child.role() + ": " + line);
  }
  return lines;
}

void RunProcesses::end_planner() {
  if (const auto planner = child(kPlanner); planner != children_.end()) {
    planner->terminate(kPatience_s);
  }
}

void RunProcesses::end_all() {
  for (ChildProcess& child : children_) {
    if (child.role() != kRecorder) child.signal(SIGTERM);
  }
  for (ChildProcess& child : children_) {
    if (child.role() != kRecorder) child.terminate(kPatience_s);
  }
  if (const auto recorder = child(kRecorder); recorder != children_.end()) {
    recorder->terminate(kPatience_s);
  }
}

std::map<std::string, std::int64_t> RunProcesses::peak_memory_bytes() const {
  std::map<std::string, std::int64_t> bytes = memory_of_ended_;
  for (const ChildProcess& child : children_) {
    std::int64_t& peak = bytes[child.role()];
    peak = std::max(peak, child.peak_memory_bytes());
  }
  return bytes;
}

}  // namespace nextview
