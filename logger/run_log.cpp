#include "logger/run_log.h"

#include <xxhash.h>

#include <algorithm>

#include "lcmtypes/bus.h"
#include "lcmtypes/decode.h"

namespace nextview {

RunLog::RunLog(const std::filesystem::path& file, std::optional<std::int64_t> run,
               RangeImages range_images, const std::optional<RunKey>& key)
    : RunLog(std::vector{file}, run, range_images, key) {}

RunLog::RunLog(const std::vector<std::filesystem::path>& files, std::optional<std::int64_t> run,
               RangeImages range_images, const std::optional<RunKey>& key)
    : run_(run), record_(range_images) {
  for (const std::filesystem::path& file : files) readers_.emplace_back(file, key);
}

std::optional<LoggedMessage> RunLog::next() {
  for (;;) {
    auto message = readers_[reading_].next();
    note_damage();
    if (message || reading_ + 1 == readers_.size()) return message;
    const LogReader& ended = readers_[reading_];
    if (ended.bytes_left() > 0) {
      contents_.add_damage(ended.file().string(), {ended.position(), ended.bytes_left()});
    }
    ++reading_;
    damage_noted_ = 0;
  }
}

void RunLog::note_damage() {
  const LogReader& reader = readers_[reading_];
  for (; damage_noted_ < reader.damaged().size(); ++damage_noted_) {
    contents_.add_damage(reader.file().string(), reader.damaged()[damage_noted_]);
  }
}

void RunLog::read_on() {
  for (begin_ = position(); auto message = next(); begin_ = position()) {
    ++counters_.messages;
    contents_.add(*message);
    if (!run_ && message->channel != Channel<run_config_t>::name) {
      before_config_.push_back(std::move(*message));
      continue;
    }
    take(*message);
    if (!run_ || before_config_.empty()) continue;
    for (const LoggedMessage& earlier : std::exchange(before_config_, {})) take(earlier);
  }
}

void RunLog::note_begin(int view) {
  if (view > settled_views_) begin_of_view_.try_emplace(view, begin_);
}

std::int64_t RunLog::begin_of_view(int view) const {
  const auto begin = begin_of_view_.find(view);
  return begin == begin_of_view_.end() ? 0 : begin->second;
}

void RunLog::settle(int views) {
  settled_views_ = std::max(settled_views_, views);
  begin_of_view_.erase(begin_of_view_.begin(), begin_of_view_.upper_bound(settled_views_));
  const std::string images(Channel<range_image_t>::name);
  seen_.erase(seen_.lower_bound({images, {}}),
              seen_.lower_bound({images, {settled_views_ + 1, 0, 0}}));
  record_.forget_searches(settled_views_);
}

void RunLog::take(const LoggedMessage& message) {
  bool ours = false;
  for_each_channel([&]<class Message>() {
    if (message.channel != Channel<Message>::name) return;
    ours = true;
    take_as<Message>(message);
  });
  // LCM_SELF_TEST, which every program on the bus starts with, is nobody's message.
  if (!ours && message.channel != "LCM_SELF_TEST") ++counters_.foreign;
}

template <class Message>
void RunLog::take_as(const LoggedMessage& message) {
  if (!message.is_authentic()) {
    dropped_.push_back("a message on " + message.channel + " is not signed by the run's key");
    return;
  }
  const Decoded<Message> decoded = decode_checked<Message>(message.message());
  if (!decoded.message) {
    dropped_.push_back("a message on " + message.channel + " cannot be right: " + decoded.reason);
    return;
  }
  if constexpr (std::is_same_v<Message, run_config_t>) {
    if (!run_) run_ = decoded.message->run;
    if (decoded.message->run != *run_ && std::find(other_runs_.begin(), other_runs_.end(),
                                                   decoded.message->run) == other_runs_.end()) {
      other_runs_.push_back(decoded.message->run);
    }
  }
  if (decoded.message->run != *run_) {
    ++counters_.foreign;
    ++counters_.of_other_runs;
    return;
  }
  ++counters_.ours;
  if (message.signature == Signature::Unchecked) ++counters_.signatures_unchecked;
  if constexpr (Channel<Message>::answered) {
    const MessageKey key = key_of(*decoded.message);
    if constexpr (std::is_same_v<Message, range_image_t>) {
      if (key.view <= settled_views_) {
        ++counters_.repeated;
        return;
      }
    }
    const XXH128_hash_t hash = XXH3_128bits(message.bytes.data(), message.bytes.size());
    const auto [seen, is_new] =
        seen_.emplace(std::pair(message.channel, key), Hash(hash.high64, hash.low64));
    if (!is_new) {
      ++counters_.repeated;
      if (seen->second == Hash(hash.high64, hash.low64)) return;
      if constexpr (std::is_same_v<Message, stop_t>) {
        // A planner's end and the run's own can cross each other.
        later_ends_.push_back("the log holds another end after the first one, " +
                              decoded.message->stop_reason + " after view " +
                              std::to_string(decoded.message->views));
      } else {
        contradictions_.push_back(
            describe(MissingMessage{Channel<Message>::name, key.view, key.attempt}) +
            " is there twice, and the two differ");
      }
      return;
    }
  }
  if constexpr (requires { record_.add(*decoded.message); }) {
    try {
      record_.add(*decoded.message);
      if constexpr (Channel<Message>::answered) note_begin(key_of(*decoded.message).view);
    } catch (const RejectedMessage& rejected) {
      const MessageKey key = key_of(*decoded.message);
      seen_.erase({message.channel, key});  // the true one may still come
      dropped_.push_back(describe(MissingMessage{Channel<Message>::name, key.view, key.attempt}) +
                         " does not fit the rest: " + rejected.what());
    }
  }
}

}  // namespace nextview
