#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "logger/run_log.h"
#include "reports/view_rows.h"
#include "scoring/view_bound.h"
#include "scoring/visible_surface.h"

namespace nextview {

/// A run when it is over, as it is written down.
struct FinishedRun {
  run_config_t config{};
  std::string stop_reason;  ///< as the log names it
  std::string stop_detail;
  std::vector<ViewRow> rows;
  int collisions = 0;      ///< goals the base refused because its body would have touched something
  int other_refusals = 0;  ///< goals it refused for another reason
  std::optional<VisibleSurface> visible;
  std::string coverage_unknown;   ///< why there is no surface coverage; empty when there is
  std::string precision_unknown;  ///< why there is no surface precision; empty when there is
  std::vector<ViewBound> bounds;  ///< how few views the scene takes; empty while that is not known
  std::string bound_command;      ///< what would tell; empty when there is no scene
  double wall_s = 0.0;            ///< from the start of the program
  double start_up_s = 0.0;        ///< from there to the first goal
  double first_goal_to_last_commit_s = 0.0;               ///< as seen on the bus
  std::map<std::string, std::int64_t> peak_memory_bytes;  ///< by role
  std::size_t map_memory_bytes = 0;                       ///< of the voxel map alone, at the end
  std::map<std::string, status_t> statuses;               ///< by role, as last heard
  LogCounters log;
  std::string lcm_url;
};

/// Where a run's artefacts are.
struct ArtefactFiles {
  std::filesystem::path log;
  std::filesystem::path views;
  std::filesystem::path summary;

  /// run.lcmlog, views.csv, summary.json in a folder.
  explicit ArtefactFiles(const std::filesystem::path& folder);
};

/// views.csv: one row a view, empty where there is nothing to say.
void write_views(std::ostream& out, const FinishedRun& run);
/// summary.json.
void write_summary(std::ostream& out, const FinishedRun& run);
/// The table people see at the end.
void write_table(std::ostream& out, const FinishedRun& run);

}  // namespace nextview
