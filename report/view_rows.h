#pragma once

#include <optional>
#include <string>
#include <vector>

#include "logger/run_record.h"
#include "mapper/map_builder.h"
#include "scoring/surface_coverage.h"

namespace nextview {

/// One view of a run as people look at it: the pose, the decision that chose it, the map after it,
/// and where the time went.
struct ViewRow {
  int view = 0;
  goal_t goal{};        ///< of the attempt that arrived
  arrival_t arrival{};  ///< likewise
  commit_t commit{};
  std::optional<double> surface_coverage;
  double scan_wall_s = 0.0;
  double first_plan_wall_s = 0.0;  ///< the decision of attempt 1, made beside the mapper's update
  double refused_wall_s = 0.0;     ///< refusals of the base, and the decisions that followed them
  double fold_wall_s = 0.0;        ///< the planner's own map update and digest
  double wait_wall_s = 0.0;        ///< of the planner, for the range image and the commit

  bool chosen() const { return view > 1; }  ///< view 1 is the scan at the start
};

/// Makes the rows of a run, in order, as its messages come in; folds the range images for the
/// coverage as the mapper does.
class ViewRows {
 public:
  explicit ViewRows(const run_config_t& config);

  /// Makes the next row if everything it needs is there, and frees its range image.
  /// @return the row, valid until the next call; nullptr when something is missing
  const ViewRow* advance(RunRecord& record);

  /// What could be seen at best has become known.
  void set_visible(const VisibleSurface& surface);

  /// Fills in what is known later than the row itself: coverage, and the planner's times.
  void complete(const RunRecord& record);

  const std::vector<ViewRow>& rows() const { return rows_; }

 private:
  MapBuilder builder_;
  SurfaceCoverage coverage_;
  std::vector<ViewRow> rows_;
};

}  // namespace nextview
