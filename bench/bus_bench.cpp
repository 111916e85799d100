// Round trips between two members of a bus in two threads: a goal there, what was tried back, each
// of them validated, encoded, sent, received, checked and decoded as in a run.

#include <benchmark/benchmark.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <thread>

#include "bench/bench_groups.h"
#include "lcmtypes/bus.h"
#include "runner/port_lock.h"

namespace nextview {

namespace {

constexpr int kTripsAtATime = 8;  // publishers are held to bursts of 16
constexpr std::chrono::milliseconds kBurstPause(8);
constexpr std::chrono::milliseconds kWait(100);

goal_t goal_of_bytes(std::size_t bytes) {
  goal_t goal{};
  goal.view = 1;
  goal.strategy = "bench";
  while (static_cast<std::size_t>(goal.getEncodedSize()) < bytes) {
    goal.waypoint_m.push_back({1.0, 2.0, 3.0});
    ++goal.waypoints;
  }
  return goal;
}

search_t search_of_bytes(std::size_t bytes) {
  search_t search{};
  search.view = 1;
  while (static_cast<std::size_t>(search.getEncodedSize()) < bytes) {
    search.tried_position_m.push_back({1.0, 2.0, 3.0});
    search.tried_pan_rad.push_back(0.0);
    search.tried_tilt_rad.push_back(0.0);
    search.tried_fitness.push_back(1.0);
    search.tried_move.push_back(0);
    ++search.tried;
  }
  return search;
}

// Answers every goal by a search of the same key until it goes.
class Echo {
 public:
  Echo(const std::string& lcm_url, std::int64_t run, std::size_t bytes)
      : bus_(lcm_url, run, "echo"), answer_(search_of_bytes(bytes)) {
    bus_.on<goal_t>([this](const goal_t& goal) {
      answer_.attempt = goal.attempt;
      bus_.publish(answer_);
    });
    thread_ = std::thread([this] {
      while (!stop_) bus_.handle(std::chrono::milliseconds(10));
    });
  }
  Echo(const Echo&) = delete;
  Echo& operator=(const Echo&) = delete;
  ~Echo() {
    stop_ = true;
    thread_.join();
  }

 private:
  Bus bus_;
  search_t answer_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

void round_trips(benchmark::State& state, std::size_t bytes) {
  // A port of its own keeps other runs out; the number, what is left of an earlier one on it.
  const std::int64_t run = std::chrono::steady_clock::now().time_since_epoch().count() / 1000;
  try {
    const PortLock port = PortLock::acquire();
    const std::string lcm_url = port.lcm_url();
    Echo echo(lcm_url, run, bytes);
    Bus bus(lcm_url, run, "bench");
    int answered = 0;
    bus.on<search_t>([&answered](const search_t&) { ++answered; });
    goal_t goal = goal_of_bytes(bytes);
    std::int64_t lost = 0;
    for (auto _ : state) {
      std::this_thread::sleep_for(kBurstPause);
      const auto start = std::chrono::steady_clock::now();
      for (int trip = 0; trip < kTripsAtATime; ++trip) {
        ++goal.attempt;
        const int before = answered;
        bus.publish(goal);
        while (answered == before) {
          if (!bus.handle(kWait)) {
            ++lost;
            break;
          }
        }
      }
      state.SetIterationTime(
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    state.SetItemsProcessed(state.iterations() * kTripsAtATime);
    state.counters["lost"] = static_cast<double>(lost);
  } catch (const std::runtime_error& error) {
    state.SkipWithError(error.what());
  }
}

}  // namespace

void register_bus(const BenchOptions&) {
  for (const int kilobytes : {2, 8}) {
    benchmark::RegisterBenchmark(
        ("bus/nextview/round_trip/" + std::to_string(kilobytes) + "KB").c_str(),
        [kilobytes](benchmark::State& state) {
          round_trips(state, static_cast<std::size_t>(kilobytes) * 1024);
        })
        ->UseManualTime()
        ->Unit(benchmark::kMicrosecond);
  }
}

}  // namespace nextview
