#include "runner/log_completion.h"

#include <chrono>
#include <vector>

#include "lcmtypes/ask_timer.h"

namespace nextview {

using std::chrono::milliseconds;
using Clock = HeardRun::Clock;

void request(Bus& bus, const MissingMessage& missing) {
  for_each_channel([&]<class Message>() {
    if (missing.channel == Channel<Message>::name) {
      bus.request<Message>(missing.view, missing.attempt);
    }
  });
}

std::set<MissingMessage> lacking_in_log(const RunRecord& logged, const RunRecord& heard) {
  std::set<MissingMessage> lacking;
  for (const MissingMessage& missing : logged.missing()) {
    if (missing.view > 0 && missing.view <= logged.views_taken()) lacking.insert(missing);
  }
  const std::vector<MissingMessage> in_log = logged.held();
  const std::set<MissingMessage> there(in_log.begin(), in_log.end());
  for (const MissingMessage& held : heard.held()) {
    if (!there.contains(held)) lacking.insert(held);
  }
  return lacking;
}

void read_log_to_its_end(RunLog& log, Bus& bus, const HeardRun& heard) {
  // The recorder is behind. Neither it nor the view under way is waited for when it does not get
  // on, nor for ever.
  constexpr milliseconds kQuiet{100};
  constexpr milliseconds kPatience{1000};
  constexpr milliseconds kLongest{10000};
  AskTimer reminder(milliseconds(20), milliseconds(2000));
  const auto start = Clock::now();
  auto grew = start;
  std::size_t had = 0;
  for (;;) {
    bus.handle(milliseconds(5));
    log.read_on();
    const RunRecord& logged = log.record();
    const auto now = Clock::now();
    if (const std::size_t has = logged.held().size(); has != had) {
      had = has;
      grew = now;
    }
    const std::set<MissingMessage> lacking = lacking_in_log(logged, heard.record);
    const bool whole = lacking.empty() && logged.latest_view() == logged.committed_views();
    if (now - grew > (whole ? kQuiet : kPatience) || now - start > kLongest) return;
    if (!reminder.due()) continue;
    bus.request<status_t>(0, 0);  // the recorder writes out what it holds when more comes
    for (const MissingMessage& message : lacking) request(bus, message);
  }
}

void publish_into_log(const stop_t& stop, RunLog& log, Bus& bus) {
  bus.publish(stop);
  const auto until = Clock::now() + milliseconds(1000);
  while (!log.record().stop() && Clock::now() < until) {
    bus.handle(milliseconds(5));
    log.read_on();
  }
}

}  // namespace nextview
