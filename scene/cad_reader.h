#pragma once

#include <sys/types.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "scene/cad_answer.h"
#include "scene/scene_options.h"

namespace nextview {

/// nextview_cad_reader at work on one file. It cannot outlive the thread that has started it.
///
/// A program of its own, and not a fork of this one: this one has threads, after whose fork a child
/// may only call what is safe in a signal handler, and assimp is not. It runs in a process group of
/// its own, so that Ctrl-C in a terminal reaches only this program, which then ends it.
class CadReader {
 public:
  /// @throws SceneError when it cannot be started
  CadReader(const std::filesystem::path& file, const SceneOptions& options);
  CadReader(const CadReader&) = delete;
  CadReader& operator=(const CadReader&) = delete;
  /// Kills it if it still runs.
  ~CadReader();

  /// Waits for its end, so many milliseconds at most, or until a signal comes.
  /// @return whether it has ended
  bool wait_for_end(int milliseconds);
  /// What it holds in memory at this moment; 0 after its end.
  std::int64_t resident_bytes() const;

  /// After its end: what it has handed back, or nothing when that is not whole.
  std::optional<CadAnswer> answer() const;
  /// After its end: "was killed by signal 6 (Aborted)", and its last words if it had any.
  std::string how_it_ended() const;

 private:
  using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;
  static File memory_file(const char* name);

  File answer_;
  File words_;
  pid_t pid_ = -1;
  int process_ = -1;  ///< its pidfd
  std::optional<int> wait_status_;
};

}  // namespace nextview
