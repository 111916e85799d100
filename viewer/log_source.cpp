#include <chrono>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "lcmtypes/decode.h"
#include "lcmtypes/rejected_message.h"
#include "logger/log_reader.h"
#include "logger/recovered_run.h"
#include "viewer/run_follower.h"
#include "viewer/run_source.h"

namespace nextview {
namespace {

/// The messages of the first run a log has a configuration of, each once.
class LoggedRun {
 public:
  explicit LoggedRun(RunFollower& follower) : follower_(follower) {}

  void take(LoggedMessage message) {
    if (!follower_.has_config() && message.channel != Channel<run_config_t>::name) {
      before_config_.push_back(std::move(message));
      return;
    }
    hand_on(message);
    if (!follower_.has_config()) return;
    for (const LoggedMessage& earlier : std::exchange(before_config_, {})) hand_on(earlier);
  }

 private:
  void hand_on(const LoggedMessage& logged) {
    for_each_channel([&]<class Message>() {
      if constexpr (Channel<Message>::answered) {
        if (logged.channel == Channel<Message>::name) hand_on_as<Message>(logged);
      }
    });
  }
  template <class Message>
  void hand_on_as(const LoggedMessage& logged) {
    const Decoded<Message> decoded = decode_checked<Message>(logged.message());
    if (!decoded.message) return;
    if (!run_) run_ = decoded.message->run;
    if (decoded.message->run != run_) return;
    if (!seen_.emplace(Channel<Message>::name, key_of(*decoded.message)).second) return;
    try {
      follower_.add(*decoded.message);
    } catch (const RejectedMessage&) {
      // Left out, as by everybody on the bus.
    }
  }

  RunFollower& follower_;
  std::optional<std::int64_t> run_;
  std::set<std::pair<std::string_view, MessageKey>> seen_;
  std::vector<LoggedMessage> before_config_;
};

}  // namespace

void follow_log(const std::string& folder_or_log, ViewedRun& viewed, const std::stop_token& stop) {
  constexpr std::chrono::milliseconds kBetweenLooks{100};
  LogReader reader(log_file_of(folder_or_log));
  RunFollower follower(viewed);
  LoggedRun logged(follower);
  while (!stop.stop_requested() && !follower.ended()) {
    if (auto message = reader.next()) {
      logged.take(std::move(*message));
      continue;
    }
    viewed.set_note(follower.has_config() ? "The log says of no end of the run yet."
                                          : "No run's configuration is in the log yet.");
    std::this_thread::sleep_for(kBetweenLooks);
  }
}

}  // namespace nextview
