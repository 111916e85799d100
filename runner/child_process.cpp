#include "runner/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

namespace nextview {
namespace {

constexpr std::size_t kLinesKept = 5;

std::system_error last_error(const std::string& what) {
  return {errno, std::generic_category(), what};
}

/// A system call, again for as long as a signal interrupts it.
template <class Call>
auto uninterrupted(const Call& call) {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result;
}

struct Pipe {
  FileDescriptor read;
  FileDescriptor write;
};

Pipe make_pipe(int flags) {
  int ends[2];
  if (::pipe2(ends, flags) != 0) throw last_error("pipe");
  return {FileDescriptor(ends[0]), FileDescriptor(ends[1])};
}

/// What the child does between fork and exec: only calls that are safe there, because this process
/// has threads. Reports errno through the pipe when it fails.
[[noreturn]] void become(char* const* arguments, const ChildTerms& terms, pid_t parent, int output,
                         int report) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, terms.at_death == AtParentsDeath::Kill ? SIGKILL : SIGTERM);
  if (::getppid() != parent) ::_exit(127);  // the parent ended before the line above
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) ::signal(number, SIG_DFL);
  if (terms.nice_value) ::setpriority(PRIO_PROCESS, 0, *terms.nice_value);
  if (terms.kept_open >= 0) ::fcntl(terms.kept_open, F_SETFD, 0);
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  ::execvp(arguments[0], arguments);
  const int error = errno;
  [[maybe_unused]] const ssize_t written = ::write(report, &error, sizeof error);
  ::_exit(127);
}

}  // namespace

ChildProcess::ChildProcess(std::string role, const std::vector<std::string>& arguments,
                           const ChildTerms& terms)
    : role_(std::move(role)) {
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  Pipe output = make_pipe(O_CLOEXEC);
  Pipe report = make_pipe(O_CLOEXEC);
  const pid_t parent = ::getpid();
  pid_ = ::fork();
  if (pid_ < 0) throw last_error("fork");
  if (pid_ == 0) {
    become(argv.data(), terms, parent, output.write.get(), report.write.get());
  }
  report.write.reset();
  int error = 0;
  if (uninterrupted([&] { return ::read(report.read.get(), &error, sizeof error); }) ==
      sizeof error) {
    uninterrupted([&] { return ::waitpid(pid_, nullptr, 0); });
    pid_ = -1;
    throw std::system_error(error, std::generic_category(), "cannot start " + arguments[0]);
  }
  output_ = std::move(output.read);
  ::fcntl(output_.get(), F_SETFL, O_NONBLOCK);
}

ChildProcess::~ChildProcess() {
  if (pid_ < 0 || wait_status_) return;
  if (!output_) return;  // moved from
  ::kill(pid_, SIGKILL);
  uninterrupted([&] { return ::waitpid(pid_, nullptr, 0); });
}

bool ChildProcess::running() {
  if (!wait_status_) {
    int status = 0;
    if (::wait4(pid_, &status, WNOHANG, &usage_) == pid_) wait_status_ = status;
    read_output();
    if (wait_status_ && !partial_line_.empty()) add_line(std::exchange(partial_line_, {}));
  }
  return !wait_status_;
}

void ChildProcess::signal(int number) {
  if (running()) ::kill(pid_, number);
}

void ChildProcess::terminate(double patience_s) {
  if (!running()) return;
  const FileDescriptor process(static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0)));
  ::kill(pid_, SIGTERM);
  ::kill(pid_, SIGCONT);  // a process that somebody has stopped would never notice
  // Its output is read meanwhile, or it might wait for room to write its last words.
  for (double waited_s = 0.0; running() && waited_s < patience_s; waited_s += 0.05) {
    pollfd wait{process.get(), POLLIN, 0};
    ::poll(&wait, 1, 50);
  }
  if (!running()) return;
  ::kill(pid_, SIGKILL);
  int status = 0;
  if (uninterrupted([&] { return ::wait4(pid_, &status, 0, &usage_); }) == pid_) {
    wait_status_ = status;
  }
  read_output();
}

void ChildProcess::read_output() {
  char buffer[4096];
  for (;;) {
    const ssize_t count =
        uninterrupted([&] { return ::read(output_.get(), buffer, sizeof buffer); });
    if (count <= 0) return;  // nothing more for now, or the end
    partial_line_.append(buffer, static_cast<std::size_t>(count));
    for (std::size_t end; (end = partial_line_.find('\n')) != std::string::npos;) {
      add_line(partial_line_.substr(0, end));
      partial_line_.erase(0, end + 1);
    }
  }
}

void ChildProcess::add_line(std::string line) {
  if (line.empty()) return;
  last_lines_.push_back(line);
  if (last_lines_.size() > kLinesKept) last_lines_.pop_front();
  new_lines_.push_back(std::move(line));
}

std::vector<std::string> ChildProcess::take_lines() { return std::exchange(new_lines_, {}); }

std::string ChildProcess::how_it_ended() const {
  if (!wait_status_) return "still runs";
  if (WIFSIGNALED(*wait_status_)) {
    const int number = WTERMSIG(*wait_status_);
    return "was killed by signal " + std::to_string(number) + " (" + ::strsignal(number) + ")";
  }
  return "ended with status " + std::to_string(WEXITSTATUS(*wait_status_));
}

std::optional<int> ChildProcess::exit_status() const {
  if (!wait_status_ || !WIFEXITED(*wait_status_)) return std::nullopt;
  return WEXITSTATUS(*wait_status_);
}

std::int64_t ChildProcess::peak_memory_bytes() const {
  if (wait_status_) return std::int64_t{usage_.ru_maxrss} * 1024;
  std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::strtoll(line.c_str() + 6, nullptr, 10) * 1024;
  }
  return 0;
}

std::optional<std::string> find_in_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const auto file = std::filesystem::path(folder.empty() ? "." : folder) / program;
    if (::access(file.c_str(), X_OK) == 0 && std::filesystem::is_regular_file(file)) {
      return file.string();
    }
  }
  return std::nullopt;
}

}  // namespace nextview
