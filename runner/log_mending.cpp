#include "runner/log_mending.h"

#include "runner/log_completion.h"

namespace nextview {

void LogMending::begin() {
  under_way_ = true;
  timer_.restart();
}

void LogMending::step(RunLog& log, Bus& bus, const HeardRun& heard) {
  // lcm-logger's queue holds 30 messages.
  constexpr std::size_t kAtATime = 16;
  if (!under_way_ || !timer_.due()) return;
  log.read_on();
  if (const std::size_t held = log.record().held().size(); held != held_) {
    held_ = held;
    timer_.restart();
  }
  const std::set<MissingMessage> lacking = lacking_in_log(log.record(), heard.record);
  under_way_ = !lacking.empty();
  bus.request<status_t>(0, 0);  // the recorder writes out what it holds when more comes
  std::size_t asked = 0;
  for (const MissingMessage& message : lacking) {
    if (++asked > kAtATime) break;
    if (!publish_again(bus, message, heard.record)) request(bus, message, log.record());
  }
}

}  // namespace nextview
