#include "runner/log_completion.h"

#include <algorithm>
#include <chrono>
#include <vector>

#include "lcmtypes/ask_timer.h"

namespace nextview {

using std::chrono::milliseconds;
using Clock = HeardRun::Clock;

void request(Bus& bus, const MissingMessage& missing, const RunRecord& here) {
  if (missing.channel == Channel<range_image_t>::name) {
    return request_range_image(bus, here.range_image_parts(), missing.view, missing.attempt);
  }
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

bool publish_again(Bus& bus, const MissingMessage& missing, const RunRecord& heard) {
  const auto publish = [&bus](const auto* message) {
    if (message != nullptr) bus.publish(*message);
    return message != nullptr;
  };
  const int view = missing.view;
  if (missing.channel == Channel<goal_t>::name) return publish(heard.goal(view, missing.attempt));
  if (missing.channel == Channel<search_t>::name) {
    return publish(heard.search(view, missing.attempt));
  }
  if (missing.channel == Channel<arrival_t>::name) {
    return publish(heard.arrival(view, missing.attempt));
  }
  return missing.channel == Channel<commit_t>::name && publish(heard.commit(view));
}

std::optional<stop_t> end_to_publish(const std::optional<stop_t>& recorded,
                                     const std::optional<stop_t>& heard, const stop_t& own) {
  if (recorded) return std::nullopt;
  return heard ? *heard : own;
}

namespace {

/// Reads what the recorder still writes, and has what it lacks published again; ends when all is
/// there, or nothing more comes.
void read_log_to_its_end(RunLog& log, Bus& bus, const HeardRun& heard) {
  // The recorder is behind. Neither it nor the view under way is waited for when it does not get
  // on, nor for ever.
  constexpr milliseconds kQuiet{100};
  constexpr milliseconds kPatience{1000};
  constexpr milliseconds kLongest{10000};
  // lcm-logger's queue holds 30 messages.
  constexpr std::size_t kAtATime = 16;
  AskTimer reminder(milliseconds(20), milliseconds(500));
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
      reminder.restart();
    }
    const std::set<MissingMessage> lacking = lacking_in_log(logged, heard.record);
    const bool whole = lacking.empty() && logged.latest_view() == logged.committed_views();
    if (now - grew > (whole ? kQuiet : kPatience) || now - start > kLongest) return;
    if (!reminder.due()) continue;
    bus.request<status_t>(0, 0);  // the recorder writes out what it holds when more comes
    std::size_t asked = 0;
    for (const MissingMessage& message : lacking) {
      if (++asked > kAtATime) break;
      if (!publish_again(bus, message, heard.record)) request(bus, message, logged);
    }
  }
}

/// Publishes an end of the run until it is in the log, for two seconds at most.
void publish_into_log(const stop_t& stop, RunLog& log, Bus& bus) {
  bus.publish(stop);
  AskTimer again(milliseconds(20), milliseconds(200));
  const auto until = Clock::now() + milliseconds(2000);
  while (!log.record().stop() && Clock::now() < until) {
    if (again.due()) bus.publish(stop);
    bus.handle(milliseconds(5));
    log.read_on();
  }
}

}  // namespace

void log_early_end(const EndsEarly& end, RunLog& log, Bus& bus, HeardRun& heard) {
  read_log_to_its_end(log, bus, heard);
  stop_t own{};
  own.views = std::min(log.record().views_taken(), heard.record.latest_view());
  own.stop_reason = std::string(to_string(end.reason));
  own.detail = end.detail;
  const std::optional<stop_t>& recorded = log.record().stop();
  if (recorded && !heard.record.stop()) heard.record.add(*recorded);  // it was missed here
  if (const auto stop = end_to_publish(recorded, heard.record.stop(), own)) {
    publish_into_log(*stop, log, bus);
  }
}

}  // namespace nextview
