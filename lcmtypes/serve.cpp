#include "lcmtypes/serve.h"

#include <sys/resource.h>

#include <algorithm>
#include <optional>

#include "lcmtypes/ask_timer.h"
#include "lcmtypes/program_version.h"

namespace nextview {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

/// Several wait for the same message, and find at the same time that it does not come.
constexpr milliseconds kAnswerOnceWithin{3};

std::optional<run_config_t> wait_for_config(Bus& bus, const std::function<bool()>& ended) {
  // Shared with the handler, which outlives this function.
  const auto config = std::make_shared<std::optional<run_config_t>>();
  bus.on<run_config_t>([config](const run_config_t& message) { *config = message; });
  bus.request<run_config_t>(0, 0);
  AskTimer timer(milliseconds(20), ResponseTime::kLongestTimeout);
  while (!*config && !ended()) {
    bus.handle(timer.left());
    if (!*config && timer.due()) bus.request<run_config_t>(0, 0);
  }
  return *config;
}

/// A process that waits for an answer, and asks again in the time that answers take.
class Waiting {
 public:
  explicit Waiting(Bus& bus) : bus_(bus) {}

  void begins() {
    if (waits_) return;
    waits_ = true;
    since_ = Clock::now();
    timer_.restart(bus_.response_time().timeout());
  }
  /// Something has come, though not all that is waited for.
  void goes_on() { timer_.restart(bus_.response_time().timeout()); }
  /// There is work again.
  void ends() {
    if (waits_ && !asked_) bus_.note_response(Clock::now() - since_);
    waits_ = asked_ = false;
    goes_on();
  }
  bool due() { return timer_.due(); }
  milliseconds left() const { return timer_.left(); }
  void ask(BusProcess& process) {
    asked_ = true;
    process.ask_again();
  }
  bool has_asked() const { return asked_; }

 private:
  Bus& bus_;
  AskTimer timer_{ResponseTime::kFirstTimeout, ResponseTime::kLongestTimeout};
  Clock::time_point since_;
  bool waits_ = false;
  bool asked_ = false;
};

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

void serve(Bus& bus, const MakeBusProcess& make, const std::function<bool()>& ended, int catch_up) {
  const std::optional<run_config_t> config = wait_for_config(bus, ended);
  if (!config) return;
  const std::unique_ptr<BusProcess> process = make(bus, *config);
  process->catch_up_to(catch_up);
  bus.on_missing([&bus, &process](const request_t& request) {
    if (request.wanted_channel == Channel<status_t>::name) {
      publish_status(bus, "");
    } else if (request.view == 0 || request.view > bus.settled_views()) {
      process->on_missing(request);
    }
  });
  publish_status(bus, "");

  bus.answer_once_within(kAnswerOnceWithin);
  Waiting waiting(bus);
  while (!ended()) {
    if (process->step()) {
      waiting.ends();
      continue;
    }
    if (process->waits()) waiting.begins();
    if (process->behind() && !waiting.has_asked()) waiting.ask(*process);
    const std::int64_t delivered = bus.counters().delivered;
    // All that is there, so that no step is taken on half of what has been said.
    for (bool more = bus.handle(std::min(waiting.left(), process->longest_wait()));
         more && !ended();) {
      more = bus.handle(milliseconds(0));
    }
    if (bus.counters().delivered != delivered) {
      waiting.goes_on();
    } else if (waiting.due()) {
      waiting.ask(*process);
    }
  }
}

}  // namespace nextview
