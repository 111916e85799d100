#include "lcmtypes/bus.h"

#include <algorithm>
#include <iostream>
#include <stdexcept>

#include "lcmtypes/lcm_transport.h"

namespace nextview {
namespace {

std::string describe(const MessageKey& key) {
  std::string text;
  if (key.view > 0) text += "view " + std::to_string(key.view) + ", ";
  if (key.attempt > 0) text += "attempt " + std::to_string(key.attempt) + ", ";
  return text + "part " + std::to_string(key.part);
}

}  // namespace

Bus::Bus(const std::string& lcm_url, std::int64_t run, std::string role)
    : Bus(std::make_unique<LcmTransport>(lcm_url), run, std::move(role)) {}

Bus::Bus(std::unique_ptr<Transport> transport, std::int64_t run, std::string role)
    : transport_(std::move(transport)),
      run_(run),
      role_(std::move(role)),
      drop_lines_(role_, std::cerr) {
  on<request_t>([this](const request_t& request) { answer(request); });
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
  if (remember) {
    // Takes the bytes only when the key is new.
    const auto [kept, is_new] = published_[name].try_emplace(key, std::move(bytes));
    if (!is_new && kept->second != bytes) {
      throw std::logic_error(role_ + " would publish view " + std::to_string(key.view) +
                             " twice, differently, on " + name);
    }
    to_send = kept->second;
  }
  transport_->publish(channel, to_send);
}

std::size_t Bus::remembered_bytes() const {
  std::size_t bytes = 0;
  for (const auto& [channel, messages] : published_) {
    for (const auto& [key, message] : messages) bytes += message.size();
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
  publish(request);
}

void Bus::answer(const request_t& request) {
  if (request.asker == role_) return;
  const auto channel = published_.find(request.wanted_channel);
  bool found = false;
  if (channel != published_.end()) {
    for (auto message = channel->second.lower_bound({request.view, request.attempt, 0});
         message != channel->second.end() && message->first.view == request.view &&
         (request.attempt == 0 || message->first.attempt == request.attempt);
         ++message) {
      found = true;
      ++counters_.lost;
      transport_->publish(channel->first, message->second);
    }
  }
  if (!found && missing_) missing_(request);
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
    if (own != published->second.end() && !std::ranges::equal(own->second, bytes)) {
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
  if (!early_.wait_for(channel)) return;
  more_to_judge_ = true;
  if (!judging_again_) judge_again();
}

void Bus::keep_early(std::string_view channel, std::span<const std::uint8_t> bytes,
                     const TooEarly& early) {
  constexpr std::chrono::milliseconds kNotOftener{20};
  const auto now = EarlyMessages::Clock::now();
  EarlyMessages::Message message{std::string(channel),
                                 {bytes.begin(), bytes.end()},
                                 std::string(early.channel()),
                                 early.what(),
                                 early_since_.value_or(now)};
  if (!early_.keep(std::move(message))) {
    return drop(channel, std::string(early.what()) + ", and no more such messages can be kept");
  }
  if (judging_again_) return;  // it has been asked for
  const MessageKey wanted{early.view(), early.attempt(), 0};
  if (asked_early_.first == wanted && now - asked_early_.second < kNotOftener) return;
  asked_early_ = {wanted, now};
  request_channel(early.channel(), early.view(), early.attempt());
}

void Bus::judge_again() {
  judging_again_ = true;
  try {
    while (std::exchange(more_to_judge_, false)) {
      for (const EarlyMessages::Message& message : early_.take_all()) {
        early_since_ = message.since;
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
    drop(message.channel, message.reason);
  }
}

}  // namespace nextview
