// A member of the bus who knows the run's number and says what nobody asked him: the processes'
// classes refuse it, count it, name it, and the run goes the way it would have gone.

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <map>
#include <memory>

#include "base_sim/base_sim_process.h"
#include "mapper/mapper_process.h"
#include "planner/planner_process.h"
#include "runner/heard_run.h"
#include "sensor_sim/sensor_sim_process.h"
#include "tests/lcmtypes/lossy_network.h"
#include "tests/planner/boxes_run.h"

namespace nextview {
namespace {

using std::chrono::milliseconds;

constexpr int kViews = 4;

run_config_t config_of_views() {
  run_config_t config = boxes_run_config();
  config.run = 7;
  config.planner.max_views = kViews;
  return config;
}

/// What a run came to.
struct Outcome {
  std::string stop_reason;
  std::vector<std::string> digests;
  bool operator==(const Outcome& other) const = default;
};

class AttackedRun {
 public:
  AttackedRun() {
    heard_.record.add(config_);
    heard_.listen(run_bus_);
    const auto missing = [](Bus& bus, BusProcess& process) {
      bus.on_missing([&process](const request_t& request) { process.on_missing(request); });
    };
    missing(planner_bus_, planner_);
    missing(base_bus_, base_);
    missing(sensor_bus_, sensor_);
    missing(mapper_bus_, mapper_);
    spy_.on<goal_t>([this](const goal_t& goal) { goal_ = goal; });
    spy_.on<arrival_t>([this](const arrival_t& arrival) { arrival_ = arrival; });
    spy_.on<range_image_t>([this](const range_image_t& image) { image_ = image; });
    spy_.on<commit_t>([this](const commit_t& commit) { commit_ = commit; });
  }

  /// Everybody hears it, and has time to be taken in.
  template <class Message>
  void say(Message message) {
    message.run = 7;
    stranger_->publish(Channel<Message>::name, encode(message));
    for (Bus* bus : {&run_bus_, &planner_bus_, &base_bus_, &sensor_bus_, &mapper_bus_}) {
      while (bus->handle(milliseconds(0))) {
      }
    }
  }
  /// Until a view has been committed.
  void go_on_to(int view) {
    for (int asked = 0; heard_.record.committed_views() < view; ++asked) {
      ASSERT_LT(asked, 1000) << "view " << view << " does not come";
      turn();
    }
  }
  Outcome finish() {
    testing::internal::CaptureStderr();
    for (int asked = 0; !heard_.record.stop() && asked < 1000; ++asked) turn();
    said_ += testing::internal::GetCapturedStderr();
    Outcome outcome;
    if (heard_.record.stop()) outcome.stop_reason = heard_.record.stop()->stop_reason;
    for (const auto& [view, commit] : heard_.record.commits()) {
      outcome.digests.push_back(commit.map_digest);
    }
    return outcome;
  }
  std::int64_t refused() const {
    std::int64_t all = 0;
    for (const Bus* bus : {&run_bus_, &planner_bus_, &base_bus_, &sensor_bus_, &mapper_bus_}) {
      all += bus->counters().refused;
    }
    return all;
  }

  const goal_t& goal() const { return goal_.value(); }
  const arrival_t& arrival() const { return arrival_.value(); }
  const range_image_t& image() const { return image_.value(); }
  const commit_t& commit() const { return commit_.value(); }

 private:
  // One piece of everybody's work; when there is none, everybody's timer is due.
  void turn() {
    bool worked = false;
    for (BusProcess* process : processes_) worked |= process->step();
    for (Bus* bus : {&planner_bus_, &base_bus_, &sensor_bus_, &mapper_bus_, &run_bus_, &spy_}) {
      worked |= bus->handle(milliseconds(0));
    }
    if (worked) return;
    for (BusProcess* process : processes_) process->ask_again();
  }

  run_config_t config_ = config_of_views();
  LossyNetwork network_{{}, 1};
  Bus planner_bus_{network_.connect(), 7, "planner"};
  Bus base_bus_{network_.connect(), 7, "base_sim"};
  Bus sensor_bus_{network_.connect(), 7, "sensor_sim"};
  Bus mapper_bus_{network_.connect(), 7, "mapper"};
  Bus run_bus_{network_.connect(), 7, "run"};
  Bus spy_{network_.connect(), 7, "spy"};
  std::unique_ptr<Transport> stranger_ = network_.connect();
  PlannerProcess planner_{planner_bus_, config_};
  BaseSimProcess base_{base_bus_, config_};
  SensorSimProcess sensor_{sensor_bus_, config_};
  MapperProcess mapper_{mapper_bus_, config_};
  std::vector<BusProcess*> processes_{&planner_, &base_, &sensor_, &mapper_};
  HeardRun heard_;
  std::optional<goal_t> goal_;
  std::optional<arrival_t> arrival_;
  std::optional<range_image_t> image_;
  std::optional<commit_t> commit_;
  std::string said_;
};

const Outcome& undisturbed() {
  static const Outcome outcome = AttackedRun().finish();
  return outcome;
}

/// Has a stranger speak after view 2.
/// @param who_refuse how many processes refuse what he says, at least
/// @param named what the lines say that are printed of it
void expect_unmoved(const std::function<void(AttackedRun&)>& attack, int who_refuse,
                    const std::string& named) {
  AttackedRun run;
  run.go_on_to(2);
  const std::int64_t before = run.refused();
  testing::internal::CaptureStderr();
  attack(run);
  const std::string during = testing::internal::GetCapturedStderr();
  EXPECT_EQ(run.finish(), undisturbed());
  EXPECT_GE(run.refused() - before, who_refuse);
  EXPECT_NE(during.find(named), std::string::npos) << during;
}

TEST(HostileMember, FindsARunThatGoesOnWithoutHim) {
  EXPECT_EQ(undisturbed().stop_reason, "view_limit");
  EXPECT_EQ(undisturbed().digests.size(), static_cast<std::size_t>(kViews));
  AttackedRun run;
  EXPECT_EQ(run.finish(), undisturbed());
  EXPECT_EQ(run.refused(), 0) << "nothing of the run's own";
}

TEST(HostileMember, SaysWhatHasBeenSaidOtherwise) {
  expect_unmoved(
      [](AttackedRun& run) {
        goal_t goal = run.goal();
        goal.position_m[0] += 0.1;
        run.say(goal);
        arrival_t arrival = run.arrival();
        arrival.believed_position_m[0] += 0.1;
        run.say(arrival);
        commit_t commit = run.commit();
        commit.map_digest = std::string(32, '0');
        run.say(commit);
      },
      3, "differs from the one");
}

TEST(HostileMember, GivesAGoalFarAhead) {
  expect_unmoved(
      [](AttackedRun& run) {
        goal_t goal = run.goal();
        goal.view = kViews;
        run.say(goal);
        goal.view = 3;
        goal.attempt = 5;
        run.say(goal);
      },
      4, "is ahead of the run");
}

TEST(HostileMember, ArrivesWhereNobodySentTheRobot) {
  expect_unmoved(
      [](AttackedRun& run) {
        arrival_t arrival = run.arrival();
        arrival.utime = 1'000'000'000'000;
        for (const int view : {3, 4}) {  // the next one, and one that is farther ahead
          arrival.view = view;
          arrival.believed_position_m[0] = arrival.true_position_m[0] = 1.0;
          run.say(arrival);
        }
        arrival.view = 3;
        arrival.arrived = 0;
        arrival.refusal = "a wall";
        run.say(arrival);
      },
      3, "NEXTVIEW_ARRIVAL");
}

TEST(HostileMember, ScansWhereNobodyWas) {
  expect_unmoved(
      [](AttackedRun& run) {
        range_image_t image = run.image();
        for (const int view : {3, 4}) {
          image.view = view;
          run.say(image);
        }
      },
      3, "NEXTVIEW_RANGE_IMAGE");
}

TEST(HostileMember, ScansWithAnotherRaster) {
  expect_unmoved(
      [](AttackedRun& run) {
        range_image_t image = run.image();
        image.view = 3;
        image.columns = 4096;
        image.rows = 4096;
        image.first_entry = image.entries = 0;
        image.entry_sin.clear();
        image.entry_cos.clear();
        image.part = 5;
        image.parts = 20000;
        image.first_entry = 8192;
        image.first_pixel = 100;
        run.say(image);
      },
      3, "4096 x 4096 pixels");
}

TEST(HostileMember, EndsARunThatGoesOn) {
  expect_unmoved(
      [](AttackedRun& run) {
        stop_t stop{};
        stop.stop_reason = "nothing_left";
        for (const int views : {0, 1, 4}) {
          stop.views = views;
          run.say(stop);
        }
        stop.views = 2;
        stop.stop_reason = "interrupted";
        run.say(stop);
      },
      4, "nobody decided it");
}

// Where a run is between two views, an end can be; the planner's next goal tells that it was none.
TEST(HostileMember, EndsARunBetweenTwoViews) {
  AttackedRun run;
  run.go_on_to(2);
  stop_t stop{};
  stop.views = 2;
  stop.stop_reason = "nothing_left";
  testing::internal::CaptureStderr();
  run.say(stop);
  EXPECT_NO_FATAL_FAILURE(run.go_on_to(kViews));
  const std::string lines = testing::internal::GetCapturedStderr();
  EXPECT_EQ(run.finish(), undisturbed());
  EXPECT_NE(lines.find("nobody decided it: the planner goes on"), std::string::npos) << lines;
}

TEST(HostileMember, SaysNumbersAtTheEndsOfTheirTypes) {
  expect_unmoved(
      [](AttackedRun& run) {
        constexpr std::int64_t kEnd = std::numeric_limits<std::int64_t>::max();
        goal_t goal = run.goal();
        goal.view = 3;
        goal.utime = kEnd;
        run.say(goal);
        goal = run.goal();
        goal.view = 3;
        goal.position_m[0] = 1e300;
        run.say(goal);
        goal = run.goal();
        goal.view = 3;
        goal.waypoint_m[0][1] = -1e300;
        run.say(goal);
        arrival_t arrival = run.arrival();
        arrival.view = 3;
        arrival.true_position_m[2] = 1e38;
        run.say(arrival);
        arrival = run.arrival();
        arrival.view = 3;
        arrival.utime = kEnd;
        run.say(arrival);
        range_image_t image = run.image();
        image.view = 3;
        image.position_m[0] = 1e20;
        run.say(image);
        request_t request{};
        request.asker = "stranger";
        request.view = request.attempt = std::numeric_limits<std::int32_t>::max();
        for (const char* channel :
             {"NEXTVIEW_MAP_BLOCKS", "NEXTVIEW_RANGE_IMAGE", "NEXTVIEW_COMMIT"}) {
          request.wanted_channel = channel;
          run.say(request);
        }
      },
      12, "utime = 9.22");
}

TEST(HostileMember, HasManyNames) {
  expect_unmoved(
      [](AttackedRun& run) {
        status_t status{};
        status.program_version = "1";
        request_t request{};
        request.wanted_channel = "NEXTVIEW_RUN_CONFIG";
        for (int i = 0; i < 200; ++i) {
          status.role = request.asker = "stranger" + std::to_string(i);
          run.say(status);
          run.say(request);
        }
        status.role = std::string(5000, 'x');
        run.say(status);
      },
      300, "an unknown role");
}

TEST(HostileMember, ComesBeforeTheStart) {
  AttackedRun run;
  testing::internal::CaptureStderr();
  arrival_t arrival = example<arrival_t>();
  arrival.view = arrival.attempt = 1;
  run.say(arrival);
  goal_t goal = example<goal_t>();
  goal.view = 2;
  goal.attempt = 1;
  run.say(goal);
  stop_t stop{};
  stop.views = 3;
  stop.stop_reason = "view_limit";
  run.say(stop);
  testing::internal::GetCapturedStderr();
  EXPECT_EQ(run.finish(), undisturbed());
  EXPECT_GE(run.refused(), 3);
}

}  // namespace
}  // namespace nextview
