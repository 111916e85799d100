#include "runner/run_folder.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>

#include "reports/run_report.h"
#include "runner/run_setup.h"

namespace nextview {
namespace {

std::string today() { return fmt::format("{:%Y%m%d-%H%M%S}", fmt::localtime(std::time(nullptr))); }

std::filesystem::path new_folder(const RunOptions& options, const std::string& scene_name) {
  if (!options.out.empty()) return options.out;
  const auto stem = std::filesystem::path(options.runs_folder) /
                    (scene_name + "-seed" + std::to_string(options.seed) + "-" + today());
  std::filesystem::path folder = stem;
  std::error_code ignored;  // where one may not look one may not write, either
  for (int i = 2; std::filesystem::exists(folder, ignored); ++i) {
    folder = stem.string() + "-" + std::to_string(i);
  }
  return folder;
}

void require_writable(const char* option, const std::filesystem::path& folder,
                      const std::error_code& error) {
  if (!error && ::access(folder.c_str(), W_OK) == 0) return;
  throw SetupError(fmt::format("{}: {} cannot be written to: {}: name another folder", option,
                               folder.string(),
                               error ? error.message() : std::generic_category().message(errno)));
}

}  // namespace

RunFolder RunFolder::make(const RunOptions& options, const std::string& scene_name) {
  const std::filesystem::path folder = new_folder(options, scene_name);
  std::error_code error;
  const auto require_empty = [&] {
    if (!std::filesystem::exists(ArtefactFiles(folder).log, error)) return;
    throw SetupError("--out: " + folder.string() +
                     " holds a run already: name another folder, or go on with that run by "
                     "--resume " +
                     folder.string());
  };
  require_empty();
  std::filesystem::create_directories(folder, error);
  require_writable("--out", folder, error);
  RunFolder kept("--out", folder, 0.0);
  require_empty();  // nor has another run, started at the same time, begun and ended meanwhile
  return kept;
}

RunFolder RunFolder::of_earlier_run(const std::filesystem::path& folder) {
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) {
    throw SetupError("--resume: " + folder.string() + ": no such folder");
  }
  if (!std::filesystem::is_regular_file(ArtefactFiles(folder).log, error)) {
    throw SetupError("--resume: there is no run.lcmlog in " + folder.string() +
                     ", and so nothing to go on from");
  }
  require_writable("--resume", folder, {});
  constexpr double kPatience_s = 5.0;
  return {"--resume", folder, kPatience_s};
}

RunFolder::RunFolder(const char* option, std::filesystem::path path, double patience_s)
    : path_(std::move(path)), lock_(::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  for (double waited_s = 0.0; ::flock(lock_.get(), LOCK_EX | LOCK_NB) != 0; waited_s += 0.01) {
    if (errno != EWOULDBLOCK) return;  // a file system without locks
    if (waited_s >= patience_s) {
      throw SetupError(
          fmt::format("{}: {}: another run goes on in it: wait for it, or name another "
                      "folder",
                      option, path_.string()));
    }
    ::poll(nullptr, 0, 10);
  }
}

}  // namespace nextview
