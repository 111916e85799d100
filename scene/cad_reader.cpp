#include "scene/cad_reader.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <system_error>

namespace nextview {
namespace {

/// The answer goes where stdout would and its words where stderr would; signals are as at first.
class SpawnSettings {
 public:
  SpawnSettings(int answer, int words) {
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&files, answer, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, words, STDERR_FILENO);
    posix_spawnattr_init(&attributes);
    sigset_t none;
    sigset_t defaults;
    sigemptyset(&none);
    sigemptyset(&defaults);
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) sigaddset(&defaults, number);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &defaults);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(
        &attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  }
  ~SpawnSettings() {
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
};

/// The shortest that gives the same number when it is read.
std::string text_of(double number) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

std::string last_line_of(std::FILE* file) {
  std::string last;
  std::array<char, 512> line;
  std::rewind(file);
  while (std::fgets(line.data(), line.size(), file) != nullptr) {
    const std::string text(line.data(), ::strcspn(line.data(), "\n"));
    if (!text.empty()) last = text;
  }
  return last;
}

}  // namespace

CadReader::File CadReader::memory_file(const char* name) {
  const int fd = ::memfd_create(name, MFD_CLOEXEC);
  std::FILE* file = fd < 0 ? nullptr : ::fdopen(fd, "w+");
  if (file == nullptr)
    throw SceneError(std::string("no memory to read a CAD file: ") +
                     std::generic_category().message(errno));
  return {file, std::fclose};
}

CadReader::CadReader(const std::filesystem::path& file, const SceneOptions& options)
    : answer_(memory_file("answer")), words_(memory_file("words")) {
  const std::string program =
      (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "nextview_cad_reader")
          .string();
  std::array<std::string, 5> arguments = {
      program, std::to_string(::getpid()), options.unit_m ? text_of(*options.unit_m) : "-",
      options.up ? std::string(name_of(*options.up)) : "-", file.string()};
  std::array<char*, arguments.size() + 1> argv{};
  for (std::size_t i = 0; i < arguments.size(); ++i) argv[i] = arguments[i].data();
  const SpawnSettings settings(::fileno(answer_.get()), ::fileno(words_.get()));
  const int error = ::posix_spawn(&pid_, program.c_str(), &settings.files, &settings.attributes,
                                  argv.data(), environ);
  if (error != 0) {
    throw SceneError(file.string() + ": cannot be read, because " + program +
                     " cannot be started (" + std::generic_category().message(error) +
                     "): build nextview again");
  }
  process_ = static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0));
}

CadReader::~CadReader() {
  if (process_ >= 0) ::close(process_);
  if (wait_status_) return;
  ::kill(pid_, SIGKILL);
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

bool CadReader::wait_for_end(int milliseconds) {
  pollfd end{process_, POLLIN, 0};
  ::poll(&end, 1, milliseconds);
  int status = 0;
  if (!wait_status_ && ::waitpid(pid_, &status, WNOHANG) == pid_) wait_status_ = status;
  return wait_status_.has_value();
}

std::int64_t CadReader::resident_bytes() const {
  std::ifstream pages("/proc/" + std::to_string(pid_) + "/statm");
  std::int64_t size = 0;
  std::int64_t resident = 0;
  pages >> size >> resident;
  return resident * ::sysconf(_SC_PAGESIZE);
}

std::optional<CadAnswer> CadReader::answer() const {
  if (!wait_status_ || *wait_status_ != 0) return std::nullopt;
  return take_answer(answer_.get());
}

std::string CadReader::how_it_ended() const {
  std::string how = "still runs";
  if (wait_status_ && WIFSIGNALED(*wait_status_)) {
    const int number = WTERMSIG(*wait_status_);
    how = "was killed by signal " + std::to_string(number) + " (" + ::strsignal(number) + ")";
  } else if (wait_status_) {
    how = "ended with status " + std::to_string(WEXITSTATUS(*wait_status_));
  }
  const std::string words = last_line_of(words_.get());
  return words.empty() ? how : how + ", saying: " + words;
}

}  // namespace nextview
