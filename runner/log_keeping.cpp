#include "runner/log_keeping.h"

#include <algorithm>
#include <utility>

#include "runner/log_completion.h"

namespace nextview {

using std::chrono::milliseconds;

void LogKeeping::step(RunLog& log, Bus& bus, HeardRun& heard) {
  // What is on its way to the log is not to be asked for.
  constexpr milliseconds kLeast{50};
  const auto now = Clock::now();
  if (now < next_look_) return;
  next_look_ = now + std::max(kLeast, 2 * bus.response_time().timeout());
  log.read_on();
  ask_for_missed(log, bus, heard);
  settle(log, bus, heard);
}

void LogKeeping::ask_for_missed(const RunLog& log, Bus& bus, const HeardRun& heard) {
  // lcm-logger's queue holds 30 messages.
  constexpr std::size_t kAtATime = 16;
  const RunRecord& logged = log.record();
  std::set<MissingMessage> missed;
  // A recorder that is behind will still write it; one that has gone on to a later view has missed
  // it, and would only be farther behind if it were sent again before.
  for (int view = logged.whole_views() + 1; view < logged.latest_view(); ++view) {
    const auto of_view = logged.missing_of_view(view);
    missed.insert(of_view.begin(), of_view.end());
    if (missed.size() >= kAtATime) break;
  }
  const std::set<MissingMessage> before = std::exchange(missed_, std::move(missed));
  for (const MissingMessage& message : missed_) {
    if (!before.contains(message)) continue;
    if (!publish_again(bus, message, heard.record)) request(bus, message, logged);
  }
}

void LogKeeping::settle(RunLog& log, Bus& bus, HeardRun& heard) {
  if (!answers_) answers_.emplace(log.file(), log.key());
  const int whole = log.record().whole_views();
  if (whole == answers_->views()) return;
  while (answers_->views() < whole) {
    answers_->add_view(log.begin_of_view(answers_->views() + 1), log.position());
  }
  log.settle(whole);
  heard.record.forget_searches(whole);
  recorded_t recorded{};
  recorded.recorded_views = whole;
  bus.publish(recorded);
}

bool LogKeeping::take_from_log(const MissingMessage& missing, HeardRun& heard) {
  if (!answers_ || !answers_->has(missing.view)) return false;
  answers_->tell(missing.channel, missing.view, missing.attempt, heard.record.config()->run,
                 [&heard](const auto& message) { heard.take(message); });
  return true;
}

bool LogKeeping::take_view_from_log(int view, HeardRun& heard) {
  if (!answers_ || !answers_->has(view)) return false;
  const std::int64_t run = heard.record.config()->run;
  for (const std::string_view channel :
       {Channel<goal_t>::name, Channel<search_t>::name, Channel<arrival_t>::name,
        Channel<range_image_t>::name, Channel<commit_t>::name}) {
    answers_->tell(channel, view, 0, run, [&heard](const auto& message) { heard.take(message); });
  }
  return true;
}

bool LogKeeping::answer(Bus& bus, const request_t& request) {
  if (!answers_ || !answers_->has(request.view)) return false;
  answers_->answer(bus, request);
  return true;
}

}  // namespace nextview
