#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "lcmtypes/bus.h"
#include "logger/log_reader.h"

namespace nextview {

/// Answers for views whose publishers need not keep them any more, out of the log in which all of
/// them is.
class LogAnswers {
 public:
  /// @param key without whose signature no message is taken
  /// @throws LogError when the log cannot be opened
  explicit LogAnswers(const std::filesystem::path& log,
                      const std::optional<RunKey>& key = std::nullopt)
      : reader_(log, key) {}

  /// All of the next view lies between these two positions of the log.
  void add_view(std::int64_t begin, std::int64_t end) { places_.push_back({begin, end}); }
  int views() const { return static_cast<int>(places_.size()); }

  bool has(int view) const { return view >= 1 && view <= views(); }

  /// Publishes what is asked for once more, byte for byte, if it is of one of these views.
  void answer(Bus& bus, const request_t& request);
  /// Calls f(message) with each message of a channel and of one of these views, once.
  /// @param attempt 0: of all attempts
  template <class F>
  void tell(std::string_view channel, int view, int attempt, std::int64_t run, const F& f);

 private:
  struct Place {
    std::int64_t begin;
    std::int64_t end;
  };

  LogReader reader_;
  std::vector<Place> places_;  // of view 1, 2, ...
};

template <class F>
void LogAnswers::tell(std::string_view channel, int view, int attempt, std::int64_t run,
                      const F& f) {
  if (!has(view)) return;
  const Place place = places_[static_cast<std::size_t>(view) - 1];
  for_each_channel([&]<class Message>() {
    if constexpr (Channel<Message>::answered && requires(Message message) { message.view; }) {
      if (channel != Channel<Message>::name) return;
      std::set<MessageKey> told;
      reader_.seek(place.begin);
      while (reader_.position() < place.end) {
        const auto message = reader_.next();
        if (!message) return;
        if (message->channel != channel || !message->is_authentic()) continue;
        const Decoded<Message> decoded = decode_checked<Message>(message->message());
        if (!decoded.message || decoded.message->run != run) continue;
        const MessageKey key = key_of(*decoded.message);
        if (key.view != view || (attempt != 0 && key.attempt != attempt)) continue;
        if (told.insert(key).second) f(*decoded.message);
      }
    }
  });
}

}  // namespace nextview
