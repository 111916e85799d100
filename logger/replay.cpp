#include "logger/replay.h"

#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <variant>

#include "logger/expected_message.h"
#include "logger/message_fields.h"
#include "mapper/commit_message.h"
#include "planner/goal_message.h"
#include "planner/planner_config.h"
#include "sensor/sensor_config.h"

namespace nextview {
namespace {

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

run_config_t decided_by(run_config_t config, std::optional<int> threads) {
  config.planner.threads = threads.value_or(config.planner.threads);
  return config;
}

/// Goes through a log in the order in which it came about.
class Replay {
 public:
  Replay(const RunLog& log, const ReplayOptions& options)
      : log_(log),
        record_(log.record()),
        config_(*record_.config()),
        simulated_(simulated_in(record_)),
        options_(options),
        planner_(make_view_planner(decided_by(config_, options.threads))) {}

  ReplayReport run() {
    report_.differences = log_.contradictions();
    report_.remarks = log_.later_ends();
    if (record_.stop()) report_.stop_reason = record_.stop()->stop_reason;
    check_file();
    check_run_config();
    const int views = record_.views_taken();
    for (int view = 1; view <= views; ++view) replay_view(view);
    replay_attempts_after(views);
    if (record_.stop()) check_stop(*record_.stop(), views);
    tell_what_is_missing();
    tell_what_is_left(views);
    return std::move(report_);
  }

 private:
  /// Where the run is: what the next message is held against.
  struct Present {
    std::int64_t utime = 0;
    std::optional<SensorPose> pose;  // nothing where a range image is missing
  };

  template <class Message>
  MissingMessage account_for(int view, int attempt) {
    const MissingMessage name{Channel<Message>::name, view, attempt};
    accounted_.insert(name);
    return name;
  }

  /// Holds a logged message against what it must say.
  template <class Message>
  bool agree(const Message& logged, const Message& expected, const MissingMessage& name) {
    const std::vector<std::string> fields = differing_fields(logged, expected);
    if (fields.empty()) return true;
    report_.differences.push_back(describe(name) + " differs in " + joined(fields));
    return false;
  }

  /// The log as a file, whatever its messages say.
  void check_file() {
    const LogFaults faults = log_.contents().faults(
        config_.run, record_.stop() ? std::optional(record_.stop()->utime) : std::nullopt);
    const auto take_in = [](std::vector<std::string>& lines, const std::vector<std::string>& more) {
      lines.insert(lines.end(), more.begin(), more.end());
    };
    take_in(report_.differences, faults.differences);
    take_in(report_.missing, faults.missing);
    take_in(report_.remarks, faults.remarks);
    report_.sealed = faults.sealed;
    if (const std::int64_t others = log_.counters().of_other_runs; others > 0) {
      report_.remarks.push_back("there are also " + std::to_string(others) +
                                " messages of other runs");
    }
  }

  void check_run_config() {
    if (config_.utime != 0) report_.differences.push_back("the run does not start at utime 0");
  }

  void replay_view(int view) {
    const int final_attempt = record_.final_attempt(view);
    for (int attempt = 1; attempt <= final_attempt; ++attempt) {
      const arrival_t* arrival = record_.arrival(view, attempt);
      const bool is_known = record_.commit(view) || record_.range_image(view, final_attempt);
      const bool may_have_arrived = is_known || (arrival && arrival->arrived != 0);
      replay_attempt(view, attempt, attempt == final_attempt && may_have_arrived);
    }
    fold(view, final_attempt);
  }

  /// Goal, search and arrival of an attempt.
  /// @param arrived whether it was the one after which the view was taken
  void replay_attempt(int view, int attempt, bool arrived) {
    const goal_t* goal = record_.goal(view, attempt);
    const std::optional<Decision> decision = decide(view, attempt);
    if (goal) check_goal(*goal, decision);
    const search_t* search = record_.search(view, attempt);
    if (search && view > 1) check_search(*search, decision);
    const arrival_t* arrival = record_.arrival(view, attempt);
    if (!arrival) return;
    const MissingMessage name = account_for<arrival_t>(view, attempt);
    if (goal) {
      agree(
          *arrival,
          expected_arrival(*arrival, *goal, arrived, present_.pose.value_or(start_pose_of(config_)),
                           simulated_.base && (arrived || present_.pose || view == 1)),
          name);
    }
    if (!arrived) present_.utime = arrival->utime;
  }

  /// The goal of an attempt, decided again on the map as it was; nothing when it is not to be or
  /// cannot be.
  std::optional<Decision> decide(int view, int attempt) {
    if (!options_.planner || view == 1 || !whole_so_far_) return std::nullopt;
    if (attempt > 1) {
      if (!std::holds_alternative<Decision>(planner_->next_view())) return std::nullopt;
      planner_->refuse();
    }
    const NextView& next = planner_->next_view();
    if (const auto* decision = std::get_if<Decision>(&next)) return *decision;
    if (record_.goal(view, attempt)) {
      report_.differences.push_back(describe({Channel<goal_t>::name, view, attempt}) +
                                    " is found no more: " + std::get<Ending>(next).detail);
    }
    return std::nullopt;
  }

  void check_goal(const goal_t& goal, const std::optional<Decision>& decision) {
    const MissingMessage name = account_for<goal_t>(goal.view, goal.attempt);
    if (goal.view == 1) {
      agree(goal, expected_start_goal(goal, config_), name);
    } else if (decision) {
      if (agree(goal, expected_goal(goal, *decision, present_.utime), name)) ++report_.goals;
    } else {
      const Eigen::Vector3d* present_m = present_.pose ? &present_.pose->position_m : nullptr;
      const std::int64_t utime = present_.pose ? present_.utime : goal.utime;
      agree(goal, expected_goal(goal, config_, present_m, utime), name);
    }
  }

  void check_search(const search_t& search, const std::optional<Decision>& decision) {
    const MissingMessage name = account_for<search_t>(search.view, search.attempt);
    if (decision) {
      agree(search, expected_search(search, *decision, present_.utime), name);
    } else if (present_.pose) {
      search_t expected = search;
      expected.utime = present_.utime;
      agree(search, expected, name);
    }
  }

  void fold(int view, int attempt) {
    const MissingMessage commit_name = account_for<commit_t>(view, 0);
    const ReceivedRangeImage* received = record_.range_image(view, attempt);
    present_.pose.reset();
    if (!received) {
      whole_so_far_ = false;
      return;
    }
    check_image(*received);
    present_ = {received->utime, received->image.pose};
    if (!whole_so_far_) return;
    const std::optional<commit_t> expected = fold_again(*received);
    const commit_t* commit = record_.commit(view);
    if (!expected || !commit) return;
    commit_t of_this_run = *expected;
    of_this_run.run = commit->run;
    if (agree(*commit, of_this_run, commit_name)) ++report_.views;
  }

  void check_image(const ReceivedRangeImage& received) {
    const MissingMessage name = account_for<range_image_t>(received.view, received.attempt);
    const arrival_t* arrival = record_.arrival(received.view, received.attempt);
    if (!arrival) return;
    for (const std::string& what :
         contradictions_of(received, *arrival, config_, simulated_.sensor)) {
      report_.differences.push_back(describe(name) + ": " + what);
    }
  }

  std::optional<commit_t> fold_again(const ReceivedRangeImage& received) {
    try {
      const FoldReport& fold = planner_->fold(received.image);
      commit_t commit = commit_message(received, fold, planner_->builder().statistics());
      commit.map_digest = planner_->builder().digest();
      commit.history_digest = history_digest_ = history_digest(history_digest_, received);
      return commit;
    } catch (const std::invalid_argument& error) {
      report_.differences.push_back(
          describe({Channel<range_image_t>::name, received.view, received.attempt}) +
          " cannot be folded: " + error.what());
      whole_so_far_ = false;
      return std::nullopt;
    }
  }

  /// The attempts at a view that was not committed: refused, or under way when the run ended early.
  void replay_attempts_after(int views) {
    const int view = views + 1;
    const bool early = record_.ends_early();
    for (int attempt = 1; record_.goal(view, attempt) || record_.arrival(view, attempt);
         ++attempt) {
      const arrival_t* arrival = record_.arrival(view, attempt);
      replay_attempt(view, attempt, early && arrival && arrival->arrived != 0);
      attempts_after_ = attempt;
    }
    if (!early || attempts_after_ == 0) return;
    std::string begun = "view " + std::to_string(view) + " had been begun";
    if (const ReceivedRangeImage* received = record_.range_image(view, attempts_after_)) {
      check_image(*received);
      begun += ", and its range image taken, but no commit says what came of it";
    }
    report_.remarks.push_back(begun);
  }

  void check_stop(const stop_t& stop, int views) {
    const MissingMessage name{Channel<stop_t>::name, 0, 0};
    if (stop.views < views) {
      report_.differences.push_back(
          describe(name) + " differs in views: it says " + std::to_string(stop.views) +
          ", beyond which the log holds view" +
          (stop.views + 1 == views ? " " : "s " + std::to_string(stop.views + 1) + " to ") +
          std::to_string(views));
      return;
    }
    stop_t expected = stop;
    if (record_.ends_early()) {
      expected.utime = 0;
      expected.final_attempt = 0;
    } else if (whole_so_far_ && views > 0 && stop.views == views) {
      expected = expected_stop(stop, views);
    }
    agree(stop, expected, name);
  }

  /// The end the planner comes to after all that the log holds.
  stop_t expected_stop(stop_t stop, int views) {
    stop.utime = present_.utime;
    const arrival_t* last = record_.arrival(views + 1, attempts_after_);
    if (last && attempts_after_ >= config_.planner.max_attempts) {
      stop.stop_reason = to_string(StopReason::NoFeasibleGoal);
      stop.final_attempt = attempts_after_;
      stop.detail = describe_refusals(views + 1, attempts_after_, last->refusal);
      return stop;
    }
    // Before the limit of views a strategy comes to such an end by what it has decided so far.
    if (!options_.planner && record_.ends_by_search()) return stop;
    if (attempts_after_ > 0 && !options_.planner) {
      stop.stop_reason = to_string(StopReason::NoFeasibleGoal);
      return stop;
    }
    if (attempts_after_ > 0 && std::holds_alternative<Decision>(planner_->next_view())) {
      planner_->refuse();
    }
    if (const auto* ending = std::get_if<Ending>(&planner_->next_view())) {
      stop.stop_reason = to_string(ending->reason);
      stop.detail = ending->detail;
      stop.final_attempt = ending->reason == StopReason::NoFeasibleGoal ? attempts_after_ + 1 : 0;
    } else {
      report_.differences.push_back(describe({Channel<stop_t>::name, 0, 0}) + " says " +
                                    stop.stop_reason + " after view " + std::to_string(views) +
                                    ", where the planner goes on");
    }
    return stop;
  }

  void tell_what_is_missing() {
    if (record_.committed_views() == 0) report_.missing.push_back("no view is in the log");
    for (const MissingMessage& missing : record_.missing()) {
      const bool begun = !record_.stop() && missing.view > record_.views_taken();
      if (!begun) report_.missing.push_back("the log lacks " + describe(missing));
    }
    if (log_.bytes_left() > 0) {
      report_.missing.push_back("the last " + std::to_string(log_.bytes_left()) +
                                " bytes of the file are no whole message");
    }
    if (!whole_so_far_) {
      report_.missing.push_back("the maps from there on cannot be rebuilt and were not checked");
    }
  }

  /// Messages that nothing above has looked at.
  void tell_what_is_left(int views) {
    for (const MissingMessage& held : record_.held()) {
      if (!accounted_.contains(held)) tell_of(held, describe(held) + " is there", views);
    }
    for (const MissingMessage& held : record_.held_in_part()) {
      const bool is_missed = held.view <= views && held.attempt == record_.final_attempt(held.view);
      if (!is_missed) tell_of(held, describe(held) + " is there in part", views);
    }
  }

  /// A message that the run does not account for; no fault of a view that was under way.
  void tell_of(const MissingMessage& held, const std::string& what, int views) {
    const bool under_way = record_.ends_early() && held.view == views + 1;
    (under_way ? report_.remarks : report_.differences)
        .push_back(what + ", and nothing in the run led to it");
  }

  const RunLog& log_;
  const RunRecord& record_;
  const run_config_t& config_;
  Simulated simulated_;
  ReplayOptions options_;
  std::unique_ptr<ViewPlanner> planner_;
  ReplayReport report_;
  Present present_;
  bool whole_so_far_ = true;  // every range image was there to be folded
  std::string history_digest_;
  int attempts_after_ = 0;  // at the view after the last one committed
  std::set<MissingMessage> accounted_;
};

}  // namespace

ReplayReport replay(const RunLog& log, const ReplayOptions& options) {
  if (!log.record().config()) {
    ReplayReport report;
    report.differences.push_back("no run's configuration is in the log");
    return report;
  }
  return Replay(log, options).run();
}

}  // namespace nextview
