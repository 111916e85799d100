#include "planner/planner_process.h"

#include "lcmtypes/timing_message.h"
#include "mapper/mapper_config.h"
#include "planner/goal_message.h"
#include "planner/planner_config.h"
#include "sensor/sensor_config.h"

namespace nextview {
namespace {

double seconds_between(std::chrono::steady_clock::time_point start,
                       std::chrono::steady_clock::time_point end) {
  return std::chrono::duration<double>(end - start).count();
}

}  // namespace

PlannerProcess::PlannerProcess(Bus& bus, const run_config_t& config)
    : PlannerProcess(bus, config, make_view_planner(config)) {}

PlannerProcess::PlannerProcess(Bus& bus, const run_config_t& config,
                               std::unique_ptr<ViewPlanner> planner)
    : bus_(bus),
      config_(config),
      planner_(std::move(planner)),
      course_(config, Channel<range_image_t>::name) {
  subscribe();
}

void PlannerProcess::subscribe() {
  bus_.on<arrival_t>([this](const arrival_t& arrival) {
    if (is_over(arrival.view, arrival.attempt)) return;
    course_.add(arrival);
    if (arrival.arrived == 0) refusals_.emplace(std::pair(arrival.view, arrival.attempt), arrival);
  });
  bus_.on<range_image_t>([this](const range_image_t& part) {
    if (is_over(part.view, part.attempt)) return;
    check_fits_run(part, config_);
    course_.check(part);
    auto image = assembler_.add(part);
    if (image) images_.emplace(part.view, std::move(*image));
  });
  bus_.on<commit_t>([this](const commit_t& commit) {
    if (is_over(commit.view, commit.attempt)) return;
    commits_.emplace(commit.view, commit);
  });
  bus_.on<pace_t>([this](const pace_t& pace) { pace_.hear(pace, Clock::now()); });
}

bool PlannerProcess::is_over(int view, int attempt) const {
  const std::pair of_message(view, attempt);
  const std::pair present(view_, attempt_);
  if (of_message < present) return true;
  if (of_message == present) return false;
  if (view <= reached()) throw NotNow();
  throw RejectedMessage("no goal asked for view " + std::to_string(view) + ", attempt " +
                        std::to_string(attempt));
}

bool PlannerProcess::held() {
  const auto now = Clock::now();
  const bool holds = pace_.holds(view_ + 1, now);
  // A pause counts as nobody's waiting.
  if (holds && !held_) wait_wall_s_ += seconds_between(idle_since_, now);
  if (holds || held_) idle_since_ = now;
  return held_ = holds;
}

bool PlannerProcess::step() {
  if (ended_) return false;
  if (view_ == 0) {
    if (held()) return false;
    view_ = 1;
    attempt_ = 1;
    publish_goal(start_goal_message(start_pose_of(config_), config_.strategy));
    return true;
  }
  if (!folded_) {
    if (const auto image = images_.find(view_); image != images_.end()) {
      fold(image->second);
      images_.erase(images_.begin(), std::next(image));
      return true;
    }
    if (const auto refusal = refusals_.find({view_, attempt_}); refusal != refusals_.end()) {
      refused(refusal->second);
      return true;
    }
    return false;
  }
  if (const auto commit = commits_.find(view_); commit != commits_.end() && !held()) {
    finish_view(commit->second);
    return true;
  }
  if (!planned_ahead_) {
    plan();
    planned_ahead_ = true;
    idle_since_ = Clock::now();
    return true;
  }
  return false;
}

void PlannerProcess::fold(const ReceivedRangeImage& received) {
  const auto start = Clock::now();
  wait_wall_s_ = seconds_between(idle_since_, start);
  planner_->fold(received.image);
  assembler_.forget_until(received.view);
  bus_.ignore_before<range_image_t>(received.view + 1);
  digest_ = planner_->builder().digest();
  utime_ = received.utime;
  folded_ = true;
  idle_since_ = Clock::now();
  fold_wall_s_ = seconds_between(start, idle_since_);
}

void PlannerProcess::finish_view(const commit_t& commit) {
  wait_wall_s_ += seconds_between(idle_since_, Clock::now());
  if (digest_ != commit.map_digest) {
    stop(StopReason::DigestMismatch, "view " + std::to_string(view_) + ": the mapper's map has " +
                                         commit.map_digest + ", the planner's " + digest_);
    return;
  }
  commits_.erase(commits_.begin(), commits_.upper_bound(view_));
  refusals_.erase(refusals_.begin(), refusals_.upper_bound({view_, attempt_}));
  bus_.ignore_before<commit_t>(view_ + 1);
  bus_.ignore_before<arrival_t>(view_);
  ++view_;
  attempt_ = 1;
  folded_ = false;
  if (!planned_ahead_) plan();
  planned_ahead_ = false;
  publish_next();
}

void PlannerProcess::refused(const arrival_t& arrival) {
  utime_ = arrival.utime;
  if (view_ == 1 || attempt_ >= config_.planner.max_attempts) {
    stop(StopReason::NoFeasibleGoal, describe_refusals(view_, attempt_, arrival.refusal));
    return;
  }
  ++attempt_;
  planner_->refuse();
  plan();
  publish_next();
}

void PlannerProcess::plan() {
  const auto start = Clock::now();
  planner_->next_view();
  plan_wall_s_ = seconds_between(start, Clock::now());
}

void PlannerProcess::publish_next() {
  const NextView& next = planner_->next_view();
  if (const Ending* ending = std::get_if<Ending>(&next)) {
    // Of the view that is not reached only a search that found nothing counts as an attempt.
    if (ending->reason != StopReason::NoFeasibleGoal) attempt_ = 0;
    stop(ending->reason, ending->detail);
    return;
  }
  const Decision& decision = std::get<Decision>(next);
  publish_goal(goal_message(decision));

  search_t search = search_message(decision);
  search.utime = utime_;
  search.view = view_;
  search.attempt = attempt_;
  bus_.publish(search);
  bus_.publish(timing_message(
      bus_.role(), utime_, view_, attempt_,
      {{"plan", plan_wall_s_}, {"fold_before", fold_wall_s_}, {"wait_before", wait_wall_s_}}));
}

void PlannerProcess::publish_goal(goal_t goal) {
  goal.utime = utime_;
  goal.view = view_;
  goal.attempt = attempt_;
  course_.at_view(view_);
  course_.forget_before(view_);
  course_.add(goal);
  bus_.publish(std::move(goal));
  idle_since_ = Clock::now();
}

void PlannerProcess::stop(StopReason reason, const std::string& detail) {
  stop_t message{};
  message.utime = utime_;
  message.views = planner_->views();
  message.final_attempt = attempt_;
  message.stop_reason = std::string(to_string(reason));
  message.detail = detail;
  if (planner_->views() > 0) {
    bus_.publish(timing_message(bus_.role(), utime_, planner_->views() + 1, 0,
                                {{"fold_before", fold_wall_s_}, {"wait_before", wait_wall_s_}}));
  }
  bus_.publish(message);
  ended_ = true;
}

void PlannerProcess::ask_again() {
  if (!waits()) return;
  if (folded_) {
    bus_.request<commit_t>(view_, 0);
  } else {
    request_range_image(bus_, assembler_, view_, attempt_);
  }
}

}  // namespace nextview
