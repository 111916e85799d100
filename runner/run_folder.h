#pragma once

#include <filesystem>
#include <string>

#include "runner/file_descriptor.h"
#include "runner/run_options.h"

namespace nextview {

/// The folder of a run's artefacts, kept from other runs for as long as this, or the recorder that
/// is given lock(), lives.
class RunFolder {
 public:
  /// The folder a new run is to leave its artefacts in, made if it is not there.
  /// @throws SetupError when it cannot be written to or holds a run already
  static RunFolder make(const RunOptions& options, const std::string& scene_name);
  /// The folder of a run that is to be taken up again. The recorder of one that has just been
  /// killed still writes: it is waited for.
  /// @throws SetupError when it is not there, cannot be written to, holds no log, or a run goes on
  ///         in it
  static RunFolder of_earlier_run(const std::filesystem::path& folder);

  const std::filesystem::path& path() const { return path_; }
  /// A file descriptor; whoever holds it open keeps the folder.
  int lock() const { return lock_.get(); }

 private:
  RunFolder(const char* option, std::filesystem::path path, double patience_s);

  std::filesystem::path path_;
  FileDescriptor lock_;
};

}  // namespace nextview
