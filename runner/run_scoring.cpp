#include "runner/run_scoring.h"

#include <utility>

#include "mapper/mapper_config.h"
#include "sensor/sensor_config.h"

namespace nextview {
namespace {

constexpr const char* kNoModel = "there is no CAD model to hold the map against";
constexpr const char* kTooEarly = "the run ended before it was worked out";

}  // namespace

RunScoring::RunScoring(const RunSetup& setup, std::string cache, bool coverage)
    : setup_(setup), cache_(std::move(cache)), coverage_asked_for_(coverage) {}

void RunScoring::start() {
  if (!setup_.scene) return;
  near_work_.emplace([scene = setup_.scene, config = setup_.config](const std::stop_token& stop,
                                                                    VisibilityProgress*) {
    return NearSurface(scene->mesh(), grid_of(config), window_of(config), stop);
  });
  if (!coverage_asked_for_) return;
  visible_work_.emplace([scene = setup_.scene, config = setup_.config, cache = cache_](
                            const std::stop_token& stop, VisibilityProgress* progress) {
    return kept_visible_surface(cache, *scene, std::string(config.scene_digest),
                                start_pose_of(config).position_m, visibility_of(config), stop,
                                progress);
  });
}

void RunScoring::give_to(ViewRows& rows, std::chrono::milliseconds timeout) {
  if (near_work_) {
    if (auto near = near_work_->take(timeout)) {
      rows.set_near(std::move(*near));
      near_known_ = true;
    }
  }
  if (visible_work_) {
    if (auto visible = visible_work_->take(timeout)) {
      visible_ = std::move(*visible);
      rows.set_visible(*visible_);
    }
  }
}

void RunScoring::request_stop() {
  if (near_work_) near_work_->request_stop();
  if (visible_work_) visible_work_->request_stop();
}

std::string RunScoring::why_coverage_is_unknown() const {
  if (visible_) return {};
  if (!setup_.scene) return kNoModel;
  if (!coverage_asked_for_) return "--no-coverage was given";
  if (visible_work_ && !visible_work_->failure().empty()) return visible_work_->failure();
  return kTooEarly;
}

std::string RunScoring::why_precision_is_unknown(const std::vector<ViewRow>& rows) const {
  if (!setup_.scene) return kNoModel;
  if (near_work_ && !near_work_->failure().empty()) return near_work_->failure();
  if (!near_known_) return kTooEarly;
  return rows.empty() || !rows.back().surface_precision ? "nothing is Occupied" : std::string();
}

}  // namespace nextview
