#include "lcmtypes/run_course.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "lcmtypes/rejected_message.h"
#include "sensor/range_image_check.h"

namespace nextview {
namespace {

/// The same but for the bits that a number of 32 bits does not have.
bool near(double a, double b) {
  return std::abs(a - b) <= kUnitTolerance * std::max({1.0, std::abs(a), std::abs(b)});
}

template <class Arrival>
void check_pose(const double (&position_m)[3], double pan_rad, double tilt_rad, std::int64_t utime,
                const Arrival& arrival) {
  if (!arrival.arrived) throw RejectedMessage("its goal was refused, so nothing was scanned");
  if (!std::equal(std::begin(position_m), std::end(position_m),
                  std::begin(arrival.believed_position_m), near) ||
      !near(pan_rad, arrival.believed_pan_rad) || !near(tilt_rad, arrival.believed_tilt_rad)) {
    throw RejectedMessage("its pose is not the one the robot arrived at");
  }
  if (utime < arrival.utime) throw RejectedMessage("it was taken before the robot arrived");
}

MessageKey key_of_attempt(int view, int attempt) { return {.view = view, .attempt = attempt}; }

}  // namespace

void RunCourse::at_view(int view) { at_view_ = std::max(at_view_, view); }

void RunCourse::check_reached(int view, int attempt) const {
  check_fits_run(config_, view, attempt);
  if (view <= at_view_) return;
  throw TooEarly(
      fmt::format("view {} is ahead of the run, which is at view {} here", view, at_view_),
      leads_on_, at_view_, 0, TooEarly::Then::Forget);
}

void RunCourse::add(const goal_t& goal) {
  check_reached(goal.view, goal.attempt);
  if (goal.attempt > 1 && !goals_.contains(key_of_attempt(goal.view, goal.attempt - 1))) {
    throw TooEarly(fmt::format("view {} has no attempt {} before it", goal.view, goal.attempt - 1),
                   Channel<goal_t>::name, goal.view, 0);
  }
  goals_.emplace(key_of(goal), goal.utime);
}

void RunCourse::add(const arrival_t& arrival) {
  check_reached(arrival.view, arrival.attempt);
  const auto goal = goals_.find(key_of(arrival));
  if (goal == goals_.end()) {
    throw TooEarly(
        fmt::format("no goal asked for view {}, attempt {}", arrival.view, arrival.attempt),
        Channel<goal_t>::name, arrival.view, 0);
  }
  if (arrival.utime < goal->second) throw RejectedMessage("the robot arrived before it had a goal");
  Arrival& kept = arrivals_[key_of(arrival)];
  kept = {
      arrival.arrived != 0, {}, arrival.believed_pan_rad, arrival.believed_tilt_rad, arrival.utime};
  std::copy_n(arrival.believed_position_m, 3, kept.believed_position_m);
}

void RunCourse::check(const range_image_t& part) const {
  check_reached(part.view, part.attempt);
  check_raster(part, config_);
  const auto arrival = arrivals_.find(key_of_attempt(part.view, part.attempt));
  if (arrival == arrivals_.end()) {
    throw TooEarly(fmt::format("no arrival led to view {}, attempt {}", part.view, part.attempt),
                   Channel<arrival_t>::name, part.view, part.attempt, TooEarly::Then::JudgeAgain);
  }
  check_pose(part.position_m, part.pan_rad, part.tilt_rad, part.utime, arrival->second);
}

void RunCourse::forget_before(int view) {
  goals_.erase(goals_.begin(), goals_.lower_bound(key_of_attempt(view, 0)));
  arrivals_.erase(arrivals_.begin(), arrivals_.lower_bound(key_of_attempt(view, 0)));
}

void check_raster(const range_image_t& part, const run_config_t& config) {
  const sensor_config_t& sensor = config.sensor;
  if (part.geometry == sensor.geometry && part.columns == sensor.columns &&
      part.rows == sensor.rows) {
    return;
  }
  throw RejectedMessage(fmt::format(
      "{} x {} pixels of geometry {}, where the run's sensor has {} x {} of geometry {}",
      part.columns, part.rows, part.geometry, sensor.columns, sensor.rows, sensor.geometry));
}

void check_taken_at(const range_image_t& part, const arrival_t& arrival) {
  check_pose(part.position_m, part.pan_rad, part.tilt_rad, part.utime, arrival);
}

void check_taken_at(const commit_t& commit, const arrival_t& arrival) {
  check_pose(commit.used_position_m, commit.pan_rad, commit.tilt_rad, commit.utime, arrival);
}

}  // namespace nextview
