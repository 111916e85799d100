#include "lcmtypes/bus_process.h"

#include <sys/prctl.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <iostream>
#include <optional>

#include "lcmtypes/program_version.h"

namespace nextview {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

volatile std::sig_atomic_t stop_requested = 0;

void request_stop(int /*signal*/) { stop_requested = 1; }

void end_on_signals() {
  struct sigaction action {};
  action.sa_handler = request_stop;  // without SA_RESTART: a wait is interrupted
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

/// When to ask again for what does not come: soon, then ever less often.
class AskTimer {
 public:
  void restart() {
    interval_ = kFirst;
    due_ = Clock::now() + interval_;
  }
  bool due() const { return Clock::now() >= due_; }
  void asked() {
    interval_ = std::min(2 * interval_, kLast);
    due_ = Clock::now() + interval_;
  }
  milliseconds left() const {
    return std::max(std::chrono::ceil<milliseconds>(due_ - Clock::now()), milliseconds(0));
  }

 private:
  static constexpr milliseconds kFirst{100};
  static constexpr milliseconds kLast{800};
  milliseconds interval_ = kFirst;
  Clock::time_point due_ = Clock::now() + kFirst;
};

void publish_status(Bus& bus, const std::string& failure) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  status_t status{};
  status.lost = bus.counters().lost;
  status.repeated = bus.counters().repeated;
  status.foreign = bus.counters().foreign;
  status.refused = bus.counters().refused;
  status.peak_memory_bytes = usage.ru_maxrss * 1024;
  status.failed = !failure.empty();
  status.role = bus.role();
  status.program_version = program_version();
  status.detail = failure;
  bus.publish(status);
}

std::optional<run_config_t> wait_for_config(Bus& bus) {
  std::optional<run_config_t> config;
  bus.on<run_config_t>([&config](const run_config_t& message) { config = message; });
  bus.request<run_config_t>(0, 0);
  AskTimer timer;
  while (!config && stop_requested == 0) {
    bus.handle(timer.left());
    if (!config && timer.due()) {
      bus.request<run_config_t>(0, 0);
      timer.asked();
    }
  }
  return config;
}

void serve(Bus& bus, const MakeBusProcess& make) {
  const std::optional<run_config_t> config = wait_for_config(bus);
  if (!config) return;
  const std::unique_ptr<BusProcess> process = make(bus, *config);
  bus.on_missing([&bus, &process](const request_t& request) {
    if (request.wanted_channel == Channel<status_t>::name) {
      publish_status(bus, "");
    } else {
      process->on_missing(request);
    }
  });
  publish_status(bus, "");

  AskTimer timer;
  while (stop_requested == 0) {
    if (process->step()) {
      timer.restart();
      continue;
    }
    const std::int64_t delivered = bus.counters().delivered;
    bus.handle(timer.left());
    if (bus.counters().delivered != delivered) {
      timer.restart();
    } else if (timer.due()) {
      process->ask_again();
      timer.asked();
    }
  }
}

}  // namespace

int run_bus_process(int argc, char** argv, const std::string& role, const std::string& about,
                    const MakeBusProcess& make) {
  CLI::App app{about};
  std::string lcm_url;
  std::int64_t run = 0;
  bool end_with_parent = false;
  app.add_option("--lcm-url", lcm_url,
                 "LCM URL of the run, such as udpm://239.255.76.67:7667?ttl=0; without it "
                 "LCM_DEFAULT_URL is used, else LCM's default");
  app.add_option("--run", run, "The run to take part in; messages of other runs are ignored")
      ->required();
  app.add_flag("--end-with-parent", end_with_parent,
               "End when the process that started this one ends, however it does");
  app.set_version_flag("--version", "nextview_" + role + " " + std::string(program_version()));
  app.footer(
      "Everything else comes from the run's configuration, NEXTVIEW_RUN_CONFIG on the bus,\n"
      "which is asked for until somebody publishes it. SIGINT and SIGTERM end the process\n"
      "cleanly, with exit status 0.");
  CLI11_PARSE(app, argc, argv);
  if (end_with_parent) prctl(PR_SET_PDEATHSIG, SIGTERM);
  end_on_signals();

  std::optional<Bus> bus;
  try {
    bus.emplace(lcm_url, run, role);
    serve(*bus, make);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "nextview_" << role << ": " << error.what() << std::endl;
    try {
      if (bus) publish_status(*bus, error.what());
    } catch (const std::exception&) {
      // The bus itself is what failed; the line above and the exit status say so.
    }
    return 1;
  }
}

}  // namespace nextview
