#pragma once

#include <optional>
#include <string>
#include <vector>

#include "logger/run_record.h"
#include "mapper/map_builder.h"
#include "scoring/surface_coverage.h"
#include "scoring/surface_precision.h"

namespace nextview {

/// One view of a run as people look at it: the pose, the decision that chose it, the map after it,
/// and where the time went.
struct ViewRow {
  int view = 0;
  goal_t goal{};        ///< of the attempt that arrived
  arrival_t arrival{};  ///< likewise
  commit_t commit{};
  std::optional<double> surface_coverage;
  std::optional<double> surface_precision;

  // Wall clock, as far as the timings have come.
  using Duration = std::optional<double>;
  Duration plan_s;        ///< the decision for the attempt that arrived
  Duration first_plan_s;  ///< the decision of attempt 1, made beside the mapper's update
  Duration refused_s;     ///< refusals of the base, and the decisions that followed them
  Duration move_s;
  Duration scan_s;
  Duration update_s;  ///< the mapper's
  Duration digest_s;
  Duration fold_s;  ///< the planner's own map update and digest
  Duration wait_s;  ///< of the planner, for the range image and the commit

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
  /// Where there is surface has become known.
  void set_near(NearSurface near);

  /// Fills in what is known later than the row itself: coverage, precision and the timings.
  void complete(const RunRecord& record);

  const std::vector<ViewRow>& rows() const { return rows_; }
  /// What the voxel map takes after them.
  std::size_t map_memory_bytes() const { return builder_.map().memory_bytes(); }

 private:
  MapBuilder builder_;
  SurfaceCoverage coverage_;
  SurfacePrecision precision_;
  std::vector<ViewRow> rows_;
};

}  // namespace nextview
