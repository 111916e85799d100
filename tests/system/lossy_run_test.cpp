// The whole loop, the four processes' classes on a bus that loses, repeats and reorders: whatever
// the bus does, the run goes the same way.

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <optional>

#include "base_sim/base_sim_process.h"
#include "mapper/mapper_process.h"
#include "planner/planner_process.h"
#include "sensor_sim/sensor_sim_process.h"
#include "tests/lcmtypes/lossy_network.h"
#include "tests/planner/boxes_run.h"

namespace nextview {
namespace {

using std::chrono::milliseconds;

run_config_t boxes_config() {
  run_config_t config = boxes_run_config();
  config.sensor.columns = 128;  // 16 384 pixels: an image of two parts
  config.sensor.rows = 128;
  config.planner.max_views = 8;
  return config;
}

/// What a run came to; free of wall-clock times.
struct Outcome {
  std::string stop_reason;
  std::vector<std::string> digests;
  std::vector<std::int64_t> utimes;
  bool operator==(const Outcome& other) const = default;
};

const std::vector<std::string> kRoles = {"planner", "base_sim", "sensor_sim", "mapper"};

class SimulatedRun {
 public:
  explicit SimulatedRun(const LossyNetwork::Faults& faults, unsigned seed)
      : network_(faults, seed) {
    const run_config_t config = boxes_config();
    for (std::size_t i = 0; i < kRoles.size(); ++i) {
      buses_.emplace_back();
      processes_.emplace_back();
      start(i, config);
    }
  }

  Outcome finish() {
    Bus watcher(network_.connect(), 7, "run");
    Outcome outcome;
    std::map<int, commit_t> commits;
    watcher.on<commit_t>([&](const commit_t& commit) { commits[commit.view] = commit; });
    watcher.on<stop_t>([&](const stop_t& stop) { outcome.stop_reason = stop.stop_reason; });
    constexpr int kPatience = 2000;
    for (int asked = 0; asked < kPatience; ++asked) {
      while (turn() || watcher.handle(milliseconds(0))) {
        restart_those_due(static_cast<int>(commits.size()));
      }
      for (auto& process : processes_) process->ask_again();  // everybody's timer is due
      if (outcome.stop_reason.empty()) {
        watcher.request<stop_t>(0, 0);
        continue;
      }
      if (std::ssize(commits) == 8) break;
      for (int view = 1; view <= 8; ++view) {
        if (!commits.contains(view)) watcher.request<commit_t>(view, 0);
      }
    }
    for (const auto& [view, commit] : commits) {
      outcome.digests.push_back(commit.map_digest);
      outcome.utimes.push_back(commit.utime);
    }
    return outcome;
  }
  /// Puts a new process, which knows nothing, in the place of the one there is, as soon as the
  /// mapper has committed so many views.
  /// @param known how far it is told that the run has got; nothing: as far as it has
  void restart_after(const std::string& role, int views, std::optional<int> known = std::nullopt) {
    restarts_.emplace(views, Restart{role, known.value_or(views + 1)});
  }
  int lost() const { return network_.lost(); }

 private:
  void start(std::size_t place, const run_config_t& config) {
    const std::string& role = kRoles[place];
    processes_[place].reset();
    buses_[place] = std::make_unique<Bus>(network_.connect(), 7, role);
    Bus& bus = *buses_[place];
    auto& process_here = processes_[place];
    if (role == "planner") process_here = std::make_unique<PlannerProcess>(bus, config);
    if (role == "base_sim") process_here = std::make_unique<BaseSimProcess>(bus, config);
    if (role == "sensor_sim") process_here = std::make_unique<SensorSimProcess>(bus, config);
    if (role == "mapper") process_here = std::make_unique<MapperProcess>(bus, config);
    BusProcess* process = process_here.get();
    buses_[place]->on_missing(
        [process](const request_t& request) { process->on_missing(request); });
  }
  void restart_those_due(int views) {
    while (!restarts_.empty() && restarts_.begin()->first <= views) {
      const auto [role, known] = restarts_.extract(restarts_.begin()).mapped();
      const auto place = std::find(kRoles.begin(), kRoles.end(), role) - kRoles.begin();
      start(static_cast<std::size_t>(place), boxes_config());
      processes_[static_cast<std::size_t>(place)]->catch_up_to(known);
    }
  }
  // One piece of everybody's work; false when all wait.
  bool turn() {
    bool worked = false;
    for (std::size_t i = 0; i < buses_.size(); ++i) {
      worked |= processes_[i]->step();
      worked |= buses_[i]->handle(milliseconds(0));
    }
    return worked;
  }

  LossyNetwork network_;
  struct Restart {
    std::string role;
    int known;
  };
  std::multimap<int, Restart> restarts_;  // by the views after which
  std::vector<std::unique_ptr<Bus>> buses_;
  std::vector<std::unique_ptr<BusProcess>> processes_;
};

TEST(LossyRun, GoesTheSameWayWhateverTheBusLoses) {
  const Outcome undisturbed = SimulatedRun({}, 1).finish();
  EXPECT_EQ(undisturbed.stop_reason, "view_limit");
  ASSERT_EQ(undisturbed.digests.size(), 8U);
  EXPECT_NE(undisturbed.digests[0], undisturbed.digests[7]);
  int lost = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SimulatedRun run({.loss = 0.1 * seed, .repeat = 0.2, .overtake = 0.2}, seed);
    EXPECT_EQ(run.finish(), undisturbed) << "seed " << seed;
    lost += run.lost();
  }
  EXPECT_GT(lost, 100);
  std::cout << lost << " messages lost in 5 runs\n";
}

TEST(LossyRun, GoesTheSameWayWhoeverIsStartedAgain) {
  const Outcome undisturbed = SimulatedRun({}, 1).finish();
  for (const std::string& role : kRoles) {
    for (int views : {1, 4, 7}) {
      SimulatedRun run({}, 1);
      run.restart_after(role, views);
      EXPECT_EQ(run.finish(), undisturbed) << role << " after view " << views;
    }
    SimulatedRun lossy({.loss = 0.2, .repeat = 0.2, .overtake = 0.2}, 3);
    lossy.restart_after(role, 5);
    EXPECT_EQ(lossy.finish(), undisturbed) << role << " on a bus that loses";
  }
}

// Whoever starts a process again may have heard less of the run than was said.
TEST(LossyRun, GoesTheSameWayWhoeverIsStartedAgainAndToldTooLittle) {
  const Outcome undisturbed = SimulatedRun({}, 1).finish();
  for (const std::string& role : kRoles) {
    for (const double loss : {0.0, 0.2}) {
      SimulatedRun run({.loss = loss}, 3);
      run.restart_after(role, 6, 2);
      EXPECT_EQ(run.finish(), undisturbed) << role << ", loss " << loss;
    }
  }
}

TEST(LossyRun, GoesTheSameWayWhenAllAreStartedAgain) {
  const Outcome undisturbed = SimulatedRun({}, 1).finish();
  for (int views : {1, 5, 8}) {
    SimulatedRun run({.loss = 0.1}, 2);
    for (const std::string& role : kRoles) run.restart_after(role, views);
    EXPECT_EQ(run.finish(), undisturbed) << "after view " << views;
  }
}

}  // namespace
}  // namespace nextview
