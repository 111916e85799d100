#include "planner/view_planner.h"

#include <stdexcept>
#include <utility>

#include "lcmtypes/parameter_bounds.h"

namespace nextview {

void ViewPlanner::Parameters::check() const {
  bounds::kMaxViews.require(max_views);
  bounds::kThreads.require(threads);
}

ViewPlanner::ViewPlanner(const VoxelGrid& grid, const MapWindow& window,
                         std::unique_ptr<Strategy> strategy, const Parameters& parameters)
    : parameters_((parameters.check(), parameters)),
      builder_(grid, window),
      strategy_(std::move(strategy)),
      space_(builder_.map(), strategy_->surfaces(), parameters.threads) {}

const FoldReport& ViewPlanner::fold(const RangeImage& image) {
  space();  // the report of the fold before is gone with this one
  const FoldReport& report = builder_.fold(image);
  not_in_space_ = &report;
  ++views_;
  attempt_ = 1;
  present_ = image.pose;
  refused_.clear();
  next_.reset();
  strategy_->view_folded({views_, present_, report, builder_.statistics()});
  return report;
}

const KnownSpace& ViewPlanner::space() {
  if (not_in_space_ != nullptr) {
    space_.update(not_in_space_->changed_slots, not_in_space_->updated_surfaces);
    not_in_space_ = nullptr;
  }
  return space_;
}

const NextView& ViewPlanner::next_view() {
  if (views_ == 0) throw std::logic_error("no view has been folded to decide on");
  if (!next_) next_ = decide();
  return *next_;
}

NextView ViewPlanner::decide() {
  if (attempt_ == 1) {
    if (std::optional<Ending> ending = strategy_->ending()) return *std::move(ending);
    if (views_ >= parameters_.max_views) {
      return Ending{StopReason::ViewLimit, std::string(describe(StopReason::ViewLimit))};
    }
  }
  return strategy_->next_view(
      {space(), present_, parameters_.seed, views_ + 1, attempt_, refused_});
}

void ViewPlanner::refuse() {
  if (!next_ || !std::holds_alternative<Decision>(*next_)) {
    throw std::logic_error("there is no goal that could be refused");
  }
  refused_.push_back(std::get<Decision>(*next_).pose);
  ++attempt_;
  next_.reset();
}

}  // namespace nextview
