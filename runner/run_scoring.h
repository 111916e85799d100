#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "reports/view_rows.h"
#include "runner/background_scoring.h"
#include "runner/run_setup.h"
#include "scoring/near_surface.h"

namespace nextview {

/// What a run is scored by, worked out beside it: which voxels lie near a surface of its scene, for
/// the precision, and which of the surface can be seen at all, for the coverage. Without a CAD
/// model, or not started, both stay unknown.
class RunScoring {
 public:
  using VisibleWork = BackgroundScoring<VisibleSurface>;
  using NearWork = BackgroundScoring<NearSurface>;

  /// @param setup of the run, which must outlive this
  /// @param cache folder where what was worked out is kept on disk
  /// @param coverage whether the coverage is asked for
  RunScoring(const RunSetup& setup, std::string cache, bool coverage);

  /// Starts to work it out, in threads of its own; without a CAD model there is nothing to do.
  void start();
  /// Gives the rows what is known by now.
  /// @param timeout how long to wait for each that is still being worked out
  void give_to(ViewRows& rows, std::chrono::milliseconds timeout);
  /// Ends the work soon.
  void request_stop();

  bool pending() const { return near_pending() || coverage_pending(); }
  bool coverage_pending() const { return visible_work_ && visible_work_->pending(); }
  /// How much of the work for the coverage is done, 0 to 100.
  int percent() const { return visible_work_ ? visible_work_->percent() : 0; }

  /// What can be seen of the scene, once it is known.
  const std::optional<VisibleSurface>& visible() const { return visible_; }
  /// In words; empty when it is known.
  std::string why_coverage_is_unknown() const;
  /// @param rows of the run's table
  std::string why_precision_is_unknown(const std::vector<ViewRow>& rows) const;

 private:
  bool near_pending() const { return near_work_ && near_work_->pending(); }

  const RunSetup& setup_;
  std::string cache_;
  bool coverage_asked_for_;
  bool near_known_ = false;
  std::optional<VisibleSurface> visible_;
  std::optional<NearWork> near_work_;
  std::optional<VisibleWork> visible_work_;
};

}  // namespace nextview
