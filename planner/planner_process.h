#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lcmtypes/bus_process.h"
#include "lcmtypes/heard_pace.h"
#include "lcmtypes/run_course.h"
#include "planner/view_planner.h"
#include "sensor/range_image_message.h"

namespace nextview {

/// The planner on the bus: a goal for every view, until the run ends.
///
/// It folds the same range images as the mapper with the mapper's own library and holds its digest
/// against every commit, so the map it decides on is the map the run has. It decides while the
/// commit is still on its way, and publishes the goal once the commit has come with its own digest.
class PlannerProcess : public BusProcess {
 public:
  PlannerProcess(Bus& bus, const run_config_t& config);
  /// With a strategy of one's own.
  PlannerProcess(Bus& bus, const run_config_t& config, std::unique_ptr<ViewPlanner> planner);

  /// Takes the run one step on: the first goal; the fold of a range image; the next decision; after
  /// the commit its goal or the end; after a refusal the next attempt.
  bool step() override;
  /// Asks for the range image or the commit of the present view. Whoever lacks its own input for
  /// that asks for it in turn, down to the goal.
  void ask_again() override;
  bool waits() const override { return view_ > 0 && !ended_ && !held_; }
  /// One that has been started again decides all anew, on the same range images and refusals as the
  /// one before it, and says the same.
  bool behind() const override { return !ended_ && view_ <= reached(); }
  void on_missing(const request_t&) override {}  // it waits for nothing else to publish its own

 private:
  using Clock = std::chrono::steady_clock;

  void subscribe();
  /// Whether what is said of an attempt at a view comes after that is over.
  /// @throws RejectedMessage when there is no such attempt yet; NotNow when it is one of a process
  ///         that this one takes the place of
  bool is_over(int view, int attempt) const;
  /// Whether the next goal has to wait because somebody has paused the run.
  bool held();
  void fold(const ReceivedRangeImage& received);
  void finish_view(const commit_t& commit);
  void refused(const arrival_t& arrival);
  /// Decides what comes next; the bus hears of it from publish_next.
  void plan();
  void publish_next();
  void publish_goal(goal_t goal);
  void stop(StopReason reason, const std::string& detail);

  Bus& bus_;
  run_config_t config_;
  std::unique_ptr<ViewPlanner> planner_;

  // What has come and waits for its turn.
  RunCourse course_;
  RangeImageAssembler assembler_;
  std::map<int, ReceivedRangeImage> images_;           // by view
  std::map<int, commit_t> commits_;                    // by view
  std::map<std::pair<int, int>, arrival_t> refusals_;  // by view and attempt

  // Where the run is: attempt of view, which is folded or not, and with the next view decided on or
  // not; 0 before the first goal.
  int view_ = 0;
  int attempt_ = 0;
  bool folded_ = false;
  bool planned_ahead_ = false;
  bool ended_ = false;
  HeardPace pace_;
  bool held_ = false;  // when last looked
  std::int64_t utime_ = 0;
  std::string digest_;  // of the map after the last fold
  Clock::time_point idle_since_;
  double fold_wall_s_ = 0.0;
  double plan_wall_s_ = 0.0;
  double wait_wall_s_ = 0.0;
};

}  // namespace nextview
