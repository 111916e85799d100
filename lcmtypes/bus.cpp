#include "lcmtypes/bus.h"

#include <iostream>
#include <stdexcept>

#include "lcmtypes/lcm_transport.h"

namespace nextview {

Bus::Bus(const std::string& lcm_url, std::int64_t run, std::string role)
    : Bus(std::make_unique<LcmTransport>(lcm_url), run, std::move(role)) {}

Bus::Bus(std::unique_ptr<Transport> transport, std::int64_t run, std::string role)
    : transport_(std::move(transport)), run_(run), role_(std::move(role)) {
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

void Bus::drop(std::string_view channel, std::string_view reason) {
  ++counters_.refused;
  std::cerr << role_ << ": dropped a message on " << channel << ": " << reason << std::endl;
}

}  // namespace nextview
