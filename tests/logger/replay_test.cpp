// What a replay makes of logs that are not what they seem to be. See also tests/system, which
// replays the logs of real runs.

#include "logger/replay.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "logger/expected_message.h"
#include "logger/unchecked_fields.h"
#include "sensor/range_image_message.h"
#include "tests/logger/recorded_run.h"

namespace nextview {
namespace {

const Recording& recorded() {
  static const Recording recording = record_run();
  return recording;
}

ReplayReport replayed(const Recording& recording, bool planner = true) {
  return replay(log_of(recording), {.planner = planner});
}

std::string lines_of(const ReplayReport& report) {
  std::string text;
  for (const auto* lines : {&report.differences, &report.missing, &report.remarks}) {
    for (const std::string& line : *lines) text += line + "\n";
  }
  return text;
}

/// The status of a replay, with and without the planner, and one of its lines.
void expect_status(const Recording& recording, int status, const std::string& words) {
  for (const bool planner : {false, true}) {
    const ReplayReport report = replayed(recording, planner);
    EXPECT_EQ(report.exit_status(), status) << lines_of(report);
    EXPECT_NE(lines_of(report).find(words), std::string::npos) << "not said: " << words << "\n"
                                                               << lines_of(report);
  }
}

template <class Message>
bool any(const Message&) {
  return true;
}

Recording ended_by(const std::string& reason, int views, const Recording& recording = recorded()) {
  return changed<stop_t>(recording, [&](stop_t& stop) {
    stop.utime = 0;
    stop.views = views;
    stop.final_attempt = 0;
    stop.stop_reason = reason;
    stop.detail = "for a test";
  });
}

TEST(Replay, AgreesToARunWithARefusal) {
  const ReplayReport report = replayed(recorded());
  EXPECT_EQ(report.exit_status(), 0) << lines_of(report);
  EXPECT_EQ(report.views, 4);
  EXPECT_EQ(report.goals, 4);  // two at view 3
  EXPECT_EQ(report.stop_reason, "view_limit");
  EXPECT_TRUE(report.remarks.empty()) << lines_of(report);
}

// As a version did that knew of quality only.
TEST(Replay, AgreesToGoalsThatNameFewerFactorsWhereTheOthersAreOff) {
  const auto log = changed<goal_t>(recorded(), [](goal_t& goal) {
    if (goal.view == 1) return;
    ASSERT_EQ(goal.factor_names, "quality,structure,navigation");
    goal.factor_names = "quality";
    goal.factors = 1;
    goal.factor_value.resize(1);
  });
  EXPECT_EQ(replayed(log).exit_status(), 0) << lines_of(replayed(log));
}

TEST(Replay, ExpectsEveryFactorThatCountsOrThatTheGoalNames) {
  Decision decision;
  decision.waypoints_m = {Eigen::Vector3d::Zero()};
  decision.fitness.factors[kNavigationFactor] = 0.5;
  goal_t logged{};
  EXPECT_EQ(expected_goal(logged, decision, 0).factor_names, "navigation");
  logged.factor_names = "structure";
  const goal_t expected = expected_goal(logged, decision, 0);
  EXPECT_EQ(expected.factor_names, "structure,navigation");
  EXPECT_EQ(expected.factors, 2);
  EXPECT_EQ(expected.factor_value, (std::vector<double>{0.0, 0.5}));
}

TEST(Replay, FindsAnEndThatKnowsOfNoView) {
  const auto log = changed<stop_t>(recorded(), [](stop_t& stop) { stop.views = 0; });
  expect_status(log, 1, "it says 0, beyond which the log holds views 1 to 4");
  for (const bool planner : {false, true}) EXPECT_EQ(replayed(log, planner).views, 4);
}

TEST(Replay, FindsCommitsWithoutStatistics) {
  const auto log = changed<commit_t>(recorded(), [](commit_t& commit) {
    commit_t zeroed{};
    zeroed.utime = commit.utime;
    zeroed.run = commit.run;
    zeroed.view = commit.view;
    zeroed.attempt = commit.attempt;
    std::copy_n(commit.used_position_m, 3, zeroed.used_position_m);
    zeroed.pan_rad = commit.pan_rad;
    zeroed.tilt_rad = commit.tilt_rad;
    zeroed.map_digest = commit.map_digest;
    zeroed.history_digest = commit.history_digest;
    commit = zeroed;
  });
  expect_status(log, 1, "NEXTVIEW_COMMIT of view 2 differs in unmarked_voxels");
  EXPECT_EQ(replayed(log).differences.size(), 4U);
}

TEST(Replay, FindsPosesMovedByAMetre) {
  expect_status(changed<arrival_t>(recorded(), [](arrival_t& a) { a.true_position_m[0] += 1.0; }),
                1, "NEXTVIEW_ARRIVAL of view 2, attempt 1 differs in true_position_m");
  expect_status(
      changed<arrival_t>(recorded(), [](arrival_t& a) { a.believed_position_m[0] += 1.0; }), 1,
      "NEXTVIEW_ARRIVAL of view 2, attempt 1 differs in believed_position_m");
  expect_status(changed<goal_t>(recorded(), [](goal_t& goal) { goal.position_m[0] += 1.0; }), 1,
                "NEXTVIEW_GOAL of view 2, attempt 1 differs in ");
  expect_status(
      changed<commit_t>(recorded(), [](commit_t& commit) { commit.used_position_m[0] += 1.0; }), 1,
      "NEXTVIEW_COMMIT of view 2 differs in used_position_m");
  expect_status(
      changed<range_image_t>(recorded(), [](range_image_t& part) { part.position_m[0] += 0.1; }), 1,
      "NEXTVIEW_RANGE_IMAGE of view 2, attempt 1: its pose is not the one the robot arrived at");
  // Who has scanned and moved is known without statuses, too.
  const auto any = [](const status_t&) { return true; };
  expect_status(changed<arrival_t>(without<status_t>(recorded(), any),
                                   [](arrival_t& a) { a.true_position_m[0] += 1.0; }),
                1, "NEXTVIEW_ARRIVAL of view 2, attempt 1 differs in true_position_m");
  // All of them at once agree with each other, but not with the maps.
  Recording all = changed<arrival_t>(recorded(), [](arrival_t& arrival) {
    arrival.true_position_m[1] += 0.1;
    arrival.believed_position_m[1] += 0.1;
  });
  all = changed<goal_t>(all, [](goal_t& goal) {
    goal.position_m[1] += 0.1;
    for (auto& waypoint_m : goal.waypoint_m) waypoint_m[1] += 0.1;
  });
  all = changed<range_image_t>(all, [](range_image_t& part) { part.position_m[1] += 0.1; });
  all = changed<commit_t>(all, [](commit_t& commit) { commit.used_position_m[1] += 0.1; });
  expect_status(all, 1, "history_digest");
}

/// As a robot of one's own says it, which computes in 32 bits and drives as well as it can.
void drive_nearly_there(arrival_t& arrival) {
  for (int axis = 0; axis < 3; ++axis) {
    arrival.true_position_m[axis] += 0.001;
    arrival.believed_position_m[axis] = static_cast<float>(arrival.believed_position_m[axis]);
  }
  arrival.believed_pan_rad = static_cast<float>(arrival.believed_pan_rad);
  arrival.believed_tilt_rad = static_cast<float>(arrival.believed_tilt_rad);
  arrival.path_length_m += 0.01;
}

TEST(Replay, BelievesADriverInThePlaceOfBaseAndSensor) {
  const Recording own_base = with_driver_for("base_sim", recorded());
  const Recording own_sensor = with_driver_for("sensor_sim", recorded());
  const Recording own = with_driver_for("sensor_sim", own_base);
  for (const Recording& recording : {own_base, own_sensor, own}) {
    EXPECT_EQ(replayed(recording).exit_status(), 0) << lines_of(replayed(recording));
  }
  EXPECT_EQ(replayed(changed<arrival_t>(own, drive_nearly_there)).exit_status(), 0)
      << lines_of(replayed(changed<arrival_t>(own, drive_nearly_there)));
  // Whoever is there is held to what is known of him.
  expect_status(changed<arrival_t>(own_base, drive_nearly_there), 1,
                "its pose is not the one the robot arrived at");
  expect_status(changed<arrival_t>(own_sensor, drive_nearly_there), 1,
                "NEXTVIEW_ARRIVAL of view 2, attempt 1 differs in true_position_m");
  expect_status(
      changed<arrival_t>(own, [](arrival_t& arrival) { arrival.believed_position_m[0] += 1e-4; }),
      1, "its pose is not the one the robot arrived at");
}

TEST(Replay, SaysWhomItHasBelieved) {
  const auto unchecked = [](const Recording& recording, std::string_view channel,
                            const std::string& field) {
    return is_unchecked(unchecked_fields(log_of(recording).record(), true), channel, field);
  };
  const Recording own_base = with_driver_for("base_sim", recorded());
  const Recording own_sensor = with_driver_for("sensor_sim", recorded());
  EXPECT_FALSE(unchecked(recorded(), "NEXTVIEW_ARRIVAL", "path_length_m"));
  EXPECT_TRUE(unchecked(own_base, "NEXTVIEW_ARRIVAL", "path_length_m"));
  EXPECT_FALSE(unchecked(own_sensor, "NEXTVIEW_ARRIVAL", "path_length_m"));
  EXPECT_FALSE(unchecked(recorded(), "NEXTVIEW_ARRIVAL", "believed_pan_rad"));
  EXPECT_TRUE(unchecked(own_sensor, "NEXTVIEW_ARRIVAL", "believed_pan_rad"));
  EXPECT_FALSE(unchecked(own_base, "NEXTVIEW_RUN_CONFIG", "sensor.range_max_m"));
  EXPECT_TRUE(unchecked(own_sensor, "NEXTVIEW_RUN_CONFIG", "sensor.range_max_m"));
}

TEST(Replay, FindsArrivalsThatWereRefused) {
  const auto log = changed<arrival_t>(recorded(), [](arrival_t& arrival) {
    arrival.arrived = 0;
    arrival.refusal = "it did not want to";
  });
  expect_status(log, 1, "NEXTVIEW_ARRIVAL of view 2, attempt 1 differs in arrived, refusal");
}

TEST(Replay, FindsARefusalThatWasAnArrival) {
  const auto log = changed<arrival_t>(recorded(), [](arrival_t& arrival) {
    arrival.arrived = 1;
    arrival.refusal.clear();
  });
  expect_status(log, 1, "NEXTVIEW_ARRIVAL of view 3, attempt 1 differs in arrived");
}

TEST(Replay, FindsALastHalfThatWasCutOut) {
  Recording log = changed<stop_t>(recorded(), [](stop_t& stop) { stop.views = 2; });
  log = without<goal_t>(log, [](const goal_t& goal) { return goal.view > 2; });
  log = without<search_t>(log, [](const search_t& search) { return search.view > 2; });
  log = without<arrival_t>(log, [](const arrival_t& arrival) { return arrival.view > 2; });
  log = without<range_image_t>(log, [](const range_image_t& part) { return part.view > 2; });
  log = without<commit_t>(log, [](const commit_t& commit) { return commit.view > 2; });
  expect_status(log, 1, "NEXTVIEW_STOP says view_limit after view 2, where the planner goes on");
}

TEST(Replay, FindsAMiddleThatWasCutOut) {
  Recording log = without<commit_t>(
      recorded(), [](const commit_t& commit) { return commit.view == 2 || commit.view == 3; });
  log = without<range_image_t>(
      log, [](const range_image_t& part) { return part.view == 2 || part.view == 3; });
  expect_status(log, 3, "the log lacks NEXTVIEW_COMMIT of view 2");
  expect_status(log, 3, "the maps from there on cannot be rebuilt");
}

TEST(Replay, ChecksViewsBeyondAnEarlyEndAndNamesThem) {
  expect_status(ended_by("process_died", 2), 1, "it says 2, beyond which the log holds views 3 to");
  EXPECT_EQ(replayed(ended_by("process_died", 2)).views, 4);
}

TEST(Replay, AgreesToAnEarlyEndThatCountsItsViews) {
  for (const char* reason : {"process_died", "no_answer", "interrupted"}) {
    const ReplayReport report = replayed(ended_by(reason, 4));
    EXPECT_EQ(report.exit_status(), 0) << lines_of(report);
    EXPECT_EQ(report.views, 4);
  }
}

TEST(Replay, NamesAViewThatHadBeenBegun) {
  const Recording log = without<commit_t>(ended_by("process_died", 3),
                                          [](const commit_t& commit) { return commit.view == 4; });
  expect_status(log, 0, "view 4 had been begun, and its range image taken");
  EXPECT_EQ(replayed(log).views, 3);
}

TEST(Replay, NeverAgreesToNothing) {
  Recording log = without<commit_t>(ended_by("interrupted", 0), any<commit_t>);
  log = without<range_image_t>(log, any<range_image_t>);
  log = without<goal_t>(log, any<goal_t>);
  log = without<search_t>(log, any<search_t>);
  log = without<arrival_t>(log, any<arrival_t>);
  expect_status(log, 3, "no view is in the log");
  expect_status(without<run_config_t>(recorded(), any<run_config_t>), 1,
                "no run's configuration is in the log");
}

TEST(Replay, NamesWhatIsMissing) {
  expect_status(without<stop_t>(recorded(), any<stop_t>), 3, "the log lacks NEXTVIEW_STOP");
  expect_status(without<search_t>(recorded(), [](const search_t& s) { return s.view == 2; }), 3,
                "the log lacks NEXTVIEW_SEARCH of view 2, attempt 1");
  expect_status(without<goal_t>(recorded(), [](const goal_t& g) { return g.view == 4; }), 3,
                "the log lacks NEXTVIEW_GOAL of view 4, attempt 1");
  const Recording without_commit =
      without<commit_t>(recorded(), [](const commit_t& commit) { return commit.view == 2; });
  expect_status(without_commit, 3, "the log lacks NEXTVIEW_COMMIT of view 2");
  EXPECT_EQ(replayed(without_commit).views, 3) << "the image is there to be folded";
}

TEST(Replay, FindsMessagesThatNothingLedTo) {
  Recording log = recorded();
  for (const auto& [channel, bytes] : recorded()) {
    if (channel != Channel<goal_t>::name) continue;
    goal_t goal = *decode_checked<goal_t>(bytes).message;
    goal.attempt = 3;
    log.emplace_back(channel, encode(goal));
  }
  expect_status(log, 1, "NEXTVIEW_GOAL of view 2, attempt 3 is there, and nothing in the run led");
}

/// The recording with all but the last part of an image, as if it were of that view and attempt.
Recording with_part_of_an_image(Recording recording, int view, int attempt) {
  const RunLog log = log_of(recorded());
  auto parts = range_image_messages(log.record().range_image(4, 1)->image, view, attempt, 0, 512);
  parts.pop_back();
  EXPECT_FALSE(parts.empty());
  for (range_image_t& part : parts) {
    part.run = log.record().config()->run;
    recording.emplace_back(Channel<range_image_t>::name, encode(part));
  }
  return recording;
}

TEST(Replay, NamesAnImageOfWhichSomePartsAreThere) {
  expect_status(
      with_part_of_an_image(recorded(), 4, 3), 1,
      "NEXTVIEW_RANGE_IMAGE of view 4, attempt 3 is there in part, and nothing in the run "
      "led to it");
  // Of a view that was taken it is what is missing.
  expect_status(with_part_of_an_image(
                    without<range_image_t>(
                        recorded(), [](const range_image_t& part) { return part.view == 4; }),
                    4, 1),
                3, "the log lacks NEXTVIEW_RANGE_IMAGE of view 4, attempt 1");
}

TEST(Replay, NamesPartsOfAnImageBeyondTheEnd) {
  Recording log = without<goal_t>(recorded(), [](const goal_t& goal) { return goal.view > 3; });
  log = without<search_t>(log, [](const search_t& search) { return search.view > 3; });
  log = without<arrival_t>(log, [](const arrival_t& arrival) { return arrival.view > 3; });
  log = without<range_image_t>(log, [](const range_image_t& part) { return part.view > 3; });
  log = without<commit_t>(log, [](const commit_t& commit) { return commit.view > 3; });
  const std::string words = "NEXTVIEW_RANGE_IMAGE of view 4, attempt 1 is there in part";
  // The view under way when a run is broken off.
  expect_status(with_part_of_an_image(ended_by("interrupted", 3, log), 4, 1), 0, words);
  // After the planner's own end nothing of a view is left to come.
  expect_status(with_part_of_an_image(ended_by("nothing_new", 3, log), 4, 1), 1, words);
}

TEST(Replay, FindsAnEndForAReasonThatDoesNotHold) {
  for (const char* reason :
       {"nothing_new", "quality_reached", "no_feasible_goal", "digest_mismatch", "made_up"}) {
    const auto log = changed<stop_t>(recorded(), [&](stop_t& stop) { stop.stop_reason = reason; });
    for (const bool planner : {false, true}) {
      EXPECT_NE(replayed(log, planner).exit_status(), 0) << reason;
    }
  }
}

TEST(Replay, SaysThatOnlyThePlannerCanTellWhetherNothingIsLeft) {
  Recording log = without<goal_t>(recorded(), [](const goal_t& goal) { return goal.view > 3; });
  log = without<search_t>(log, [](const search_t& search) { return search.view > 3; });
  log = without<arrival_t>(log, [](const arrival_t& arrival) { return arrival.view > 3; });
  log = without<range_image_t>(log, [](const range_image_t& part) { return part.view > 3; });
  std::int64_t utime = 0;
  log = without<commit_t>(log, [&](const commit_t& commit) {
    if (commit.view == 3) utime = commit.utime;
    return commit.view > 3;
  });
  log = changed<stop_t>(log, [&](stop_t& stop) {
    stop.utime = utime;
    stop.views = 3;
    stop.stop_reason = "nothing_left";
  });
  EXPECT_EQ(replayed(log, false).exit_status(), 0) << lines_of(replayed(log, false));
  const RunLog read = log_of(log);
  EXPECT_TRUE(is_unchecked(unchecked_fields(read.record(), false), "NEXTVIEW_STOP", "stop_reason"));
  EXPECT_FALSE(is_unchecked(unchecked_fields(read.record(), true), "NEXTVIEW_STOP", "stop_reason"));
  EXPECT_EQ(replayed(log, true).exit_status(), 1);
}

TEST(Replay, TakesTheFirstOfTwoEnds) {
  Recording log = recorded();
  for (const auto& logged : ended_by("process_died", 3)) {
    if (logged.first == Channel<stop_t>::name) log.push_back(logged);
  }
  expect_status(log, 0, "the log holds another end after the first one, process_died after view 3");
  EXPECT_EQ(replayed(log).stop_reason, "view_limit");
}

TEST(Replay, FindsOneRefusalTooMany) {
  // As if the run had ended at view 3, whose only logged attempt was refused.
  Recording log = recorded();
  log = without<goal_t>(log, [](const goal_t& g) { return g.view == 4 || g.attempt > 1; });
  log = without<search_t>(log, [](const search_t& s) { return s.view == 4 || s.attempt > 1; });
  log = without<arrival_t>(log, [](const arrival_t& a) { return a.view == 4 || a.attempt > 1; });
  log = without<range_image_t>(log, [](const range_image_t& p) { return p.view > 2; });
  log = without<commit_t>(log, [](const commit_t& c) { return c.view > 2; });
  log = changed<stop_t>(log, [](stop_t& stop) {
    stop.views = 2;
    stop.final_attempt = 1;
    stop.stop_reason = "no_feasible_goal";
    stop.detail = "view 3: the base refused 1 goals, the last one because a chair is in the way";
  });
  expect_status(log, 1, "NEXTVIEW_STOP");
}

}  // namespace
}  // namespace nextview
