#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "exporter/mesh_simplifier.h"
#include "logger/recovered_run.h"

namespace nextview {

/// What `nextview_export` may be asked for beside the format.
struct ExportOptions {
  std::filesystem::path folder_or_log;
  std::optional<std::int64_t> run;  ///< which, when the log holds several
  int max_views = std::numeric_limits<int>::max();
  SimplifyOptions simplify;  ///< of meshes
  /// Of voxels and octrees: holes of one voxel are filled (one_voxel_holes.h), as meshes have them.
  bool fill_holes = false;
};

/// A file a run can be turned into. Its name is what a user asks for.
struct ExportFormat {
  std::string name;         ///< of the file, and what --to takes
  std::string description;  ///< one line
  /// Writes the file. @throws std::runtime_error naming the file when it cannot be written
  std::function<void(RecoveredRun& run, const ExportOptions& options,
                     const std::filesystem::path& file)>
      write;
};

/// All of them, in the order of the help.
const std::vector<ExportFormat>& export_formats();

}  // namespace nextview
