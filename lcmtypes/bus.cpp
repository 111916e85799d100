#include "lcmtypes/bus.h"

#include <algorithm>
#include <iostream>
#include <limits>
#include <stdexcept>

#include "lcmtypes/signed_transport.h"

namespace nextview {
namespace {

/// Ranges of a request for parts, so that it travels in one packet.
constexpr std::size_t kRangesPerRequest = 128;
/// So often parts are asked for before all of the message is.
constexpr int kPartsAskedInVain = 8;
/// So many messages asked for are remembered to tell how long answers take.
constexpr std::size_t kAskedRemembered = 256;
/// So much longer is a part of a message not sent again: many parts take a while to send, and who
/// waits for them asks meanwhile for what is on its way already.
constexpr int kPartsOnceWithin = 10;

std::string describe(const MessageKey& key) {
  std::string text;
  if (key.view > 0) text += "view " + std::to_string(key.view) + ", ";
  if (key.attempt > 0) text += "attempt " + std::to_string(key.attempt) + ", ";
  return text + "part " + std::to_string(key.part);
}

/// The request for all of what parts are asked for of.
request_t whole_of(const parts_request_t& parts) {
  request_t whole{};
  whole.run = parts.run;
  whole.view = parts.view;
  whole.attempt = parts.attempt;
  whole.wanted_channel = parts.wanted_channel;
  whole.asker = parts.asker;
  return whole;
}

}  // namespace

Bus::Bus(const std::string& lcm_url, std::int64_t run, std::string role,
         const std::optional<RunKey>& key)
    : Bus(transport_on(lcm_url, key), run, std::move(role)) {}

Bus::Bus(std::unique_ptr<Transport> transport, std::int64_t run, std::string role)
    : transport_(std::move(transport)),
      run_(run),
      role_(std::move(role)),
      drop_lines_(role_, std::cerr) {
  on<request_t>([this](const request_t& request) { answer(request); });
  on<parts_request_t>([this](const parts_request_t& request) { answer_parts(request); });
  on<recorded_t>([this](const recorded_t& recorded) {
    recorded_views_ = std::max(recorded_views_, recorded.recorded_views);
    forget_settled();
  });
}

void Bus::on_missing(std::function<void(const request_t&)> handler) {
  missing_ = std::move(handler);
}

void Bus::publish_bytes(std::string_view channel, const MessageKey& key, bool remember,
                        const std::string& reason, std::vector<std::uint8_t> bytes) {
  const std::string name(channel);
  if (!reason.empty()) {
    throw std::logic_error(role_ + " would publish a wrong message on " + name + ": " + reason);
  }
  if (bytes.size() > kMaxMessageBytes) {
    throw std::logic_error(role_ + " would publish " + std::to_string(bytes.size()) + " bytes on " +
                           name + ", more than a message may have");
  }
  std::span<const std::uint8_t> to_send = bytes;
  latest_published_ = std::max(latest_published_, remember ? key.view : 0);
  if (remember && (key.view == 0 || key.view > settled_views())) {
    // Takes the bytes only when the key is new.
    const auto [kept, is_new] = published_[name].try_emplace(key);
    if (is_new) {
      kept->second.bytes = std::move(bytes);
    } else if (kept->second.bytes != bytes) {
      throw std::logic_error(role_ + " would publish view " + std::to_string(key.view) +
                             " twice, differently, on " + name);
    }
    kept->second.sent = Clock::now();
    to_send = kept->second.bytes;
  }
  transport_->publish(channel, to_send);
}

std::size_t Bus::remembered_bytes() const {
  std::size_t bytes = 0;
  for (const auto& [channel, messages] : published_) {
    for (const auto& [key, message] : messages) bytes += message.bytes.size();
  }
  return bytes;
}

void Bus::take_channel(std::string_view channel) {
  if (!handled_.emplace(channel).second) {
    throw std::logic_error(role_ + " would handle " + std::string(channel) + " twice");
  }
}

void Bus::note_foreign(std::string_view channel, std::int64_t run) {
  // Once: on a shared port another run would fill the screen.
  if (++counters_.foreign > 1) return;
  std::cerr << role_ << ": ignores messages of other runs, such as one on " << channel
            << " whose run is " << run << ": what belongs to this run must have run = " << run_
            << std::endl;
}

void Bus::request_channel(std::string_view channel, int view, int attempt) {
  request_t request{};
  request.view = view;
  request.attempt = attempt;
  request.wanted_channel = std::string(channel);
  request.asker = role_;
  note_asked(channel, view, attempt);
  publish(request);
}

void Bus::request_parts_of(std::string_view channel, int view, int attempt,
                           std::span<const PartRange> parts) {
  parts_request_t request{};
  request.view = view;
  request.attempt = attempt;
  for (const PartRange& range : parts.first(std::min(parts.size(), kRangesPerRequest))) {
    request.first_wanted_part.push_back(range.first);
    request.last_wanted_part.push_back(range.last);
  }
  request.ranges = static_cast<std::int32_t>(request.first_wanted_part.size());
  request.wanted_channel = std::string(channel);
  request.asker = role_;
  if (note_asked(channel, view, attempt) % kPartsAskedInVain == 0) {
    return request_channel(channel, view, attempt);
  }
  publish(request);
}

int Bus::note_asked(std::string_view channel, int view, int attempt) {
  // Of what nobody has, nothing ever comes.
  if (asked_.size() >= kAskedRemembered) asked_.clear();
  Asked& asked = asked_[{std::string(channel), {view, attempt, 0}}];
  if (asked.times++ == 0) asked.first = Clock::now();
  return asked.times;
}

void Bus::note_come(std::string_view channel, const MessageKey& key) {
  if (asked_.empty()) return;
  for (const int attempt : {key.attempt, 0}) {
    const auto asked = asked_.find({std::string(channel), {key.view, attempt, 0}});
    if (asked == asked_.end()) continue;
    if (asked->second.times == 1) response_time_.took(Clock::now() - asked->second.first);
    asked_.erase(asked);
  }
}

void Bus::send_again(std::string_view channel, Published& message, Clock::time_point now,
                     std::chrono::milliseconds once_within) {
  if (now - message.sent < once_within) return;
  ++counters_.lost;
  message.sent = Clock::now();
  transport_->publish(channel, message.bytes);
}

void Bus::answer(const request_t& request) {
  if (request.asker == role_) return;
  const auto channel = published_.find(request.wanted_channel);
  bool found = false;
  if (channel != published_.end()) {
    Answers& answers = channel->second;
    const auto first = answers.lower_bound({request.view, request.attempt, 0});
    const auto asked_for = [&](Answers::const_iterator message) {
      return message != answers.end() && message->first.view == request.view &&
             (request.attempt == 0 || message->first.attempt == request.attempt);
    };
    found = asked_for(first);
    const bool in_parts = found && asked_for(std::next(first)) && std::next(first)->first.part > 0;
    const auto once_within =
        in_parts ? kPartsOnceWithin * answer_once_within_ : answer_once_within_;
    const auto now = Clock::now();
    for (auto message = first; asked_for(message); ++message) {
      send_again(channel->first, message->second, now, once_within);
    }
  }
  if (!found && missing_) missing_(request);
}

void Bus::answer_parts(const parts_request_t& request) {
  if (request.asker == role_) return;
  bool found = false;
  if (const auto channel = published_.find(request.wanted_channel); channel != published_.end()) {
    Answers& answers = channel->second;
    const auto now = Clock::now();
    for (std::size_t i = 0; i < request.first_wanted_part.size(); ++i) {
      const MessageKey last{request.view, request.attempt, request.last_wanted_part[i]};
      for (auto message =
               answers.lower_bound({request.view, request.attempt, request.first_wanted_part[i]});
           message != answers.end() && message->first <= last; ++message) {
        found = true;
        send_again(channel->first, message->second, now, kPartsOnceWithin * answer_once_within_);
      }
    }
  }
  if (found || !missing_) return;
  missing_(whole_of(request));
}

void Bus::forget_settled() {
  constexpr int kMost = std::numeric_limits<std::int32_t>::max();
  const MessageKey last{settled_views(), kMost, kMost};
  if (last.view < 1) return;
  for (auto& [channel, answers] : published_) {
    answers.erase(answers.lower_bound({1, 0, 0}), answers.upper_bound(last));
  }
}

void Bus::drop(std::string_view channel, std::string_view reason, std::int64_t count) {
  counters_.refused += count;
  drop_lines_.say(channel, reason, count, DropLines::Clock::now());
}

bool Bus::handle(std::chrono::milliseconds timeout) {
  const bool handled = transport_->handle(timeout);
  for (const auto& [reason, count] : transport_->take_refused()) drop({}, reason, count);
  drop_lines_.tell_sum_when_due(DropLines::Clock::now());
  if (!early_.empty()) drop_stale();
  for (const auto& wanted : wanted_.take_due()) {
    request_channel(wanted.channel, wanted.view, wanted.attempt);
  }
  return handled;
}

void Bus::receive(std::string_view channel, Transport::Receiver receiver) {
  receivers_.emplace(channel, receiver);
  transport_->subscribe(channel, std::move(receiver));
}

bool Bus::is_new(std::string_view channel, const MessageKey& key,
                 std::span<const std::uint8_t> bytes) {
  const auto published = published_.find(channel);
  if (published != published_.end()) {
    const auto own = published->second.find(key);
    if (own != published->second.end() && !std::ranges::equal(own->second.bytes, bytes)) {
      drop(channel, describe(key) + " differs from the one published here");
      return false;
    }
  }
  switch (heard_.judge(channel, key, bytes)) {
    case HeardMessages::Verdict::New:
      return true;
    case HeardMessages::Verdict::Repeated:
      ++counters_.repeated;
      return false;
    case HeardMessages::Verdict::Different:
      drop(channel, describe(key) + " differs from the one that was taken before");
      return false;
  }
  return false;
}

void Bus::taken(std::string_view channel, const MessageKey& key,
                std::span<const std::uint8_t> bytes) {
  heard_.take(channel, key, bytes);
  ++counters_.delivered;
  note_come(channel, key);
  wanted_.came(channel, key);
  if (!early_.wait_for(channel)) return;
  more_to_judge_ = true;
  if (!judging_again_) judge_again();
}

void Bus::keep_early(std::string_view channel, const MessageKey& key,
                     std::span<const std::uint8_t> bytes, const TooEarly& early) {
  const auto now = EarlyMessages::Clock::now();
  const bool kept = early.then() == TooEarly::Then::JudgeAgain;
  if (!kept) drop(channel, early.what());
  want({std::string(early.channel()), early.view(), early.attempt()}, key);
  if (early.then() == TooEarly::Then::Forget) return;
  EarlyMessages::Message message{
      std::string(channel),         key,          {},
      std::string(early.channel()), early.what(), early_since_.value_or(now)};
  if (kept) message.bytes.assign(bytes.begin(), bytes.end());
  if (!early_.keep(std::move(message)) && kept) {
    drop(channel, std::string(early.what()) + ", and no more such messages can be kept");
  }
}

void Bus::want(const WantedMessages::Wanted& wanted, const MessageKey& for_whom) {
  if (!wanted_.want(wanted, for_whom, response_time_.timeout())) return;
  request_channel(wanted.channel, wanted.view, wanted.attempt);
}

void Bus::judge_again() {
  judging_again_ = true;
  try {
    while (std::exchange(more_to_judge_, false)) {
      for (const EarlyMessages::Message& message : early_.take_all()) {
        early_since_ = message.since;
        if (message.bytes.empty()) {
          want({message.channel, message.key.view, message.key.attempt}, message.key);
          continue;
        }
        receivers_.find(message.channel)->second(message.bytes);
      }
    }
  } catch (...) {
    judging_again_ = false;
    early_since_.reset();
    throw;
  }
  judging_again_ = false;
  early_since_.reset();
}

void Bus::drop_stale() {
  for (const EarlyMessages::Message& message : early_.take_stale(EarlyMessages::Clock::now())) {
    if (!message.bytes.empty()) drop(message.channel, message.reason);
  }
}

}  // namespace nextview
