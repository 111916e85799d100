#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

#include "lcmtypes/bus.h"
#include "logger/log_reader.h"
#include "logger/run_record.h"
#include "runner/run_options.h"
#include "runner/run_setup.h"

namespace nextview {

/// The log of a run that is to be taken up again: what has been said, for those who ask for it once
/// more. It is the truth; whatever it lacks is worked out anew.
class EarlierRun {
 public:
  /// Reads the log, of which it cuts off what is behind its last whole message, and an end that the
  /// run itself, and not the planner, has put there.
  /// @param key of the run, without whose signature no message is taken; nothing: it has none
  /// @throws SetupError when the log holds no run's configuration, or was written by another
  /// version, or its messages are signed and no key is given
  /// @throws LogError when it cannot be read or changed
  explicit EarlierRun(const std::filesystem::path& log,
                      const std::optional<RunKey>& key = std::nullopt);

  const run_config_t& config() const { return *record_.config(); }
  /// Without the range images themselves.
  const RunRecord& record() const { return record_; }
  /// How much its range images' parts carry, so that they can be cut alike; 0: there is none.
  std::size_t part_bytes() const { return part_bytes_; }
  /// Whether its planner has ended it, and the log lacks nothing.
  bool is_whole() const { return record_.stop() && record_.missing().empty(); }

  /// Calls add(message) with every message of the run but its configuration, statuses and requests.
  template <class Add>
  void tell(const Add& add);
  /// Publishes what is asked for once more, byte for byte, if the log holds it.
  void answer(Bus& bus, const request_t& request);

 private:
  template <class Message>
  void take_in(const LoggedMessage& message, std::int64_t position);

  LogReader reader_;
  RunRecord record_{RangeImages::OnlyCount};
  std::size_t part_bytes_ = 0;
  std::map<std::pair<std::string_view, MessageKey>, std::int64_t> positions_;  // in the log
};

/// What a run needs that is taken up again: the configuration of its log, and its scene.
/// @throws SceneError when the scene cannot be loaded, or is no longer what it was
RunSetup set_up_again(const run_config_t& config);

template <class Add>
void EarlierRun::tell(const Add& add) {
  for (reader_.seek(0); const auto message = reader_.next();) {
    for_each_channel([&]<class Message>() {
      if constexpr (requires(RunRecord record, Message told) { record.add(told); } &&
                    !std::is_same_v<Message, run_config_t>) {
        if (message->channel != Channel<Message>::name || !message->is_authentic()) return;
        const Decoded<Message> decoded = decode_checked<Message>(message->message());
        if (decoded.message && decoded.message->run == config().run) add(*decoded.message);
      }
    });
  }
}

}  // namespace nextview
