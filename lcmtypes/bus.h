#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lcmtypes/channels.h"
#include "lcmtypes/decode.h"
#include "lcmtypes/drop_lines.h"
#include "lcmtypes/early_messages.h"
#include "lcmtypes/heard_messages.h"
#include "lcmtypes/rejected_message.h"
#include "lcmtypes/response_time.h"
#include "lcmtypes/run_key.h"
#include "lcmtypes/transport.h"
#include "lcmtypes/wanted_messages.h"

namespace nextview {

/// What the bus has seen since the start.
struct BusCounters {
  std::int64_t delivered = 0;  ///< to handlers; requests and status messages not counted
  std::int64_t foreign = 0;    ///< messages of other runs, ignored
  std::int64_t repeated = 0;   ///< messages seen before, ignored
  std::int64_t refused = 0;    ///< messages that cannot be right, and datagrams that are none
  std::int64_t lost = 0;       ///< messages sent again because somebody asked
};

/// Parts of a message, each end included.
struct PartRange {
  int first = 0;
  int last = 0;
  bool operator==(const PartRange& other) const = default;
};

/// Typed publish and subscribe for one run, lossless for those who ask.
///
/// Every message is keyed (run, view, attempt, part). What is published is remembered and sent
/// again, the same bytes, to whoever requests it, until the publisher forgets it or the run says
/// that it is in the log (recorded_t), from which the run answers then. Receivers see each key
/// once. Whoever waits requests again on a timer of its own; nothing else keeps a run whole on a
/// bus that may lose.
///
/// Anybody may publish. Under a key that has been taken, or that this process has published itself,
/// another message is refused; so is what a handler rejects. What is refused is counted, and said
/// in a line as long as there are few (DropLines).
class Bus {
 public:
  /// Joins a run over LCM.
  /// @param lcm_url as LCM has it; empty: LCM_DEFAULT_URL, else LCM's default
  /// @param role who speaks, for requests: sensor_sim, base_sim, ...
  /// @param key of the run, without whose signature no message is taken; nothing: it has none
  /// @throws BusError when the bus does not work here, saying what to type; never hangs
  Bus(const std::string& lcm_url, std::int64_t run, std::string role,
      const std::optional<RunKey>& key = std::nullopt);
  /// Joins a run over any transport.
  Bus(std::unique_ptr<Transport> transport, std::int64_t run, std::string role);
  // Receivers point back at the bus.
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  std::int64_t run_number() const { return run_; }
  const std::string& role() const { return role_; }
  const BusCounters& counters() const { return counters_; }

  /// Publishes a message of this run (sets message.run) and remembers it.
  /// @throws std::logic_error when the message is not valid, larger than kMaxMessageBytes, or its
  ///         key was published before with other bytes: all errors of the publisher's
  template <class Message>
  void publish(Message message) {
    message.run = run_;
    publish_bytes(Channel<Message>::name, key_of(message), Channel<Message>::answered,
                  check(message), encode(message));
  }

  /// Forgets what was published of the views before this one: from then on nobody answers for them
  /// but on_missing's handler, which can have them made and published again.
  template <class Message>
  void forget_before(int view) {
    const auto kept = published_.find(Channel<Message>::name);
    if (kept == published_.end()) return;
    kept->second.erase(kept->second.begin(), kept->second.lower_bound({view, 0, 0}));
  }
  /// Of all messages remembered.
  std::size_t remembered_bytes() const;

  /// From now on messages of the views before this one are as if they had been seen: whoever is
  /// through with them need not remember which of them have come.
  template <class Message>
  void ignore_before(int view) {
    heard_.ignore_before(Channel<Message>::name, view);
  }
  /// How many keys of messages that have come are remembered.
  std::size_t remembered_keys() const { return heard_.size(); }

  /// The views up to which the run answers for what was published here, and nobody else need: it
  /// has said that all of them is in the log. The last few are kept all the same, so that nobody
  /// who only says so can have anything lost.
  int settled_views() const { return std::min(recorded_views_, latest_published_ - kViewsKept); }

  /// Has what was sent so short a time ago not sent again: several who lack the same ask at the
  /// same time. Zero at first.
  void answer_once_within(std::chrono::milliseconds time) { answer_once_within_ = time; }

  /// Calls the handler with every message of this run on the type's channel, each key once (status
  /// messages, timings and requests every time).
  /// @throws std::logic_error when the type has a handler already, as request_t always has
  ///         (on_missing): of two, each key would come to one only
  template <class Message>
  void on(std::function<void(const Message&)> handler) {
    take_channel(Channel<Message>::name);
    subscribe<Message>(std::move(handler));
  }

  /// Asks whoever published it for a message of a view.
  /// @param view 0 for messages that belong to no view (run_config_t, stop_t, status_t)
  /// @param attempt 0: all attempts there are
  template <class Message>
  void request(int view, int attempt) {
    request_channel(Channel<Message>::name, view, attempt);
  }
  /// Asks for parts of a message of which others have come: as many of the ranges, from the first
  /// on, as fit a request that travels in one packet. When none of them comes, however often it
  /// was asked, for all of the message: its publisher may not know such requests.
  template <class Message>
  void request_parts(int view, int attempt, std::span<const PartRange> parts) {
    request_parts_of(Channel<Message>::name, view, attempt, parts);
  }

  /// How long answers take, from requests made here and what note_response() was told.
  const ResponseTime& response_time() const { return response_time_; }
  /// What was waited for came after so long, without being asked for.
  void note_response(ResponseTime::Seconds time) { response_time_.took(time); }

  /// Called with every request that nothing published so far answers. Who should publish it one day
  /// asks for what it needs itself. The handler sees everybody's requests and picks its own.
  void on_missing(std::function<void(const request_t&)> handler);

  /// Finds that a message that was taken cannot have been right: another one may come in its place.
  template <class Message>
  void take_back(const MessageKey& key, std::string_view reason) {
    heard_.forget(Channel<Message>::name, key);
    drop(Channel<Message>::name, reason);
  }

  /// Waits for one message and handles it.
  /// @return false when none came within the timeout, or a signal interrupted the wait
  /// @throws what a handler throws, RejectedMessage, TooEarly and NotNow apart; BusError when the
  ///         bus has broken down
  bool handle(std::chrono::milliseconds timeout);

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr int kViewsKept = 8;
  struct Published {
    std::vector<std::uint8_t> bytes;
    Clock::time_point sent;
  };
  /// When a message was asked for, and how often.
  struct Asked {
    Clock::time_point first;
    int times = 0;
  };
  using Answers = std::map<MessageKey, Published>;

  template <class Message>
  void subscribe(std::function<void(const Message&)> handler) {
    receive(Channel<Message>::name,
            [this, handler = std::move(handler)](std::span<const std::uint8_t> bytes) {
              deliver<Message>(bytes, handler);
            });
  }
  template <class Message>
  void deliver(std::span<const std::uint8_t> bytes,
               const std::function<void(const Message&)>& handler);
  void publish_bytes(std::string_view channel, const MessageKey& key, bool remember,
                     const std::string& reason, std::vector<std::uint8_t> bytes);
  void request_channel(std::string_view channel, int view, int attempt);
  void request_parts_of(std::string_view channel, int view, int attempt,
                        std::span<const PartRange> parts);
  /// @return how often this message has been asked for since something of it came
  int note_asked(std::string_view channel, int view, int attempt);
  void note_come(std::string_view channel, const MessageKey& key);
  void answer(const request_t& request);
  void answer_parts(const parts_request_t& request);
  void send_again(std::string_view channel, Published& message, Clock::time_point now,
                  std::chrono::milliseconds once_within);
  void forget_settled();
  void drop(std::string_view channel, std::string_view reason, std::int64_t count = 1);
  void receive(std::string_view channel, Transport::Receiver receiver);
  /// Whether a message is new; else it has been counted as repeated, or refused.
  bool is_new(std::string_view channel, const MessageKey& key, std::span<const std::uint8_t> bytes);
  void taken(std::string_view channel, const MessageKey& key, std::span<const std::uint8_t> bytes);
  void keep_early(std::string_view channel, const MessageKey& key,
                  std::span<const std::uint8_t> bytes, const TooEarly& early);
  /// Asks for what has to come first, now and until it does.
  void want(const WantedMessages::Wanted& wanted, const MessageKey& for_whom);
  void judge_again();
  void drop_stale();
  void take_channel(std::string_view channel);
  void note_foreign(std::string_view channel, std::int64_t run);

  std::unique_ptr<Transport> transport_;
  std::int64_t run_;
  std::string role_;
  BusCounters counters_;
  std::function<void(const request_t&)> missing_;
  std::map<std::string, Answers, std::less<>> published_;
  HeardMessages heard_;
  std::map<std::pair<std::string, MessageKey>, Asked> asked_;  // attempt 0: whichever
  ResponseTime response_time_;
  std::chrono::milliseconds answer_once_within_{0};
  int recorded_views_ = 0;                      // as the run has said
  int latest_published_ = 0;                    // view
  std::set<std::string, std::less<>> handled_;  // channels
  std::map<std::string, Transport::Receiver, std::less<>> receivers_;
  EarlyMessages early_;
  bool judging_again_ = false;
  bool more_to_judge_ = false;
  std::optional<EarlyMessages::Clock::time_point> early_since_;  // of the one judged again
  WantedMessages wanted_;
  DropLines drop_lines_;
};

template <class Message>
void Bus::deliver(std::span<const std::uint8_t> bytes,
                  const std::function<void(const Message&)>& handler) {
  const std::string_view channel = Channel<Message>::name;
  const Decoded<Message> decoded = decode_checked<Message>(bytes);
  if (!decoded.message) return drop(channel, decoded.reason);
  if (decoded.message->run != run_) {
    note_foreign(channel, decoded.message->run);
    return;
  }
  const MessageKey key = key_of(*decoded.message);
  if (Channel<Message>::answered && !is_new(channel, key, bytes)) return;
  try {
    handler(*decoded.message);
  } catch (const TooEarly& early) {
    return keep_early(channel, key, bytes, early);
  } catch (const NotNow&) {
    return;
  } catch (const RejectedMessage& rejected) {
    return drop(channel, rejected.what());  // the right one may still come
  }
  if (Channel<Message>::answered) taken(channel, key, bytes);
}

}  // namespace nextview
