#include "lcmtypes/serve.h"

#include <sys/resource.h>

#include <algorithm>
#include <optional>

#include "lcmtypes/ask_timer.h"
#include "lcmtypes/program_version.h"

namespace nextview {
namespace {

AskTimer ask_timer() {
  return AskTimer(std::chrono::milliseconds(100), std::chrono::milliseconds(800));
}

std::optional<run_config_t> wait_for_config(Bus& bus, const std::function<bool()>& ended) {
  // Shared with the handler, which outlives this function.
  const auto config = std::make_shared<std::optional<run_config_t>>();
  bus.on<run_config_t>([config](const run_config_t& message) { *config = message; });
  bus.request<run_config_t>(0, 0);
  AskTimer timer = ask_timer();
  while (!*config && !ended()) {
    bus.handle(timer.left());
    if (!*config && timer.due()) bus.request<run_config_t>(0, 0);
  }
  return *config;
}

}  // namespace

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

void serve(Bus& bus, const MakeBusProcess& make, const std::function<bool()>& ended) {
  const std::optional<run_config_t> config = wait_for_config(bus, ended);
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

  AskTimer timer = ask_timer();
  while (!ended()) {
    if (process->step()) {
      timer.restart();
      continue;
    }
    const std::int64_t delivered = bus.counters().delivered;
    // All that is there, so that no step is taken on half of what has been said.
    for (bool more = bus.handle(std::min(timer.left(), process->longest_wait()));
         more && !ended();) {
      more = bus.handle(std::chrono::milliseconds(0));
    }
    if (bus.counters().delivered != delivered) {
      timer.restart();
    } else if (timer.due()) {
      process->ask_again();
    }
  }
}

}  // namespace nextview
