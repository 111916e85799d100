#pragma once

#include <deque>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "lcmtypes/transport.h"

namespace nextview {

/// A bus without a network, for tests: everybody's messages go to everybody, and on each way one
/// may be lost, come twice or overtake another, by a seeded dice.
class LossyNetwork {
 public:
  struct Faults {
    double loss = 0.0;
    double repeat = 0.0;
    double overtake = 0.0;
  };
  using Bytes = std::vector<std::uint8_t>;

  explicit LossyNetwork(const Faults& faults, unsigned seed = 1) : faults_(faults), dice_(seed) {}

  /// A new place on the bus.
  std::unique_ptr<Transport> connect() {
    queues_.push_back(std::make_shared<Queue>());
    return std::make_unique<Endpoint>(*this, queues_.back());
  }

  /// Every message as it was published, in order.
  const std::vector<std::pair<std::string, Bytes>>& published() const { return published_; }
  int lost() const { return lost_; }

 private:
  using Queue = std::deque<std::pair<std::string, Bytes>>;

  class Endpoint : public Transport {
   public:
    Endpoint(LossyNetwork& network, std::shared_ptr<Queue> queue)
        : network_(network), queue_(std::move(queue)) {}
    void publish(std::string_view channel, std::span<const std::uint8_t> bytes) override {
      network_.send(std::string(channel), Bytes(bytes.begin(), bytes.end()));
    }
    void subscribe(std::string_view channel, Receiver receiver) override {
      receivers_[std::string(channel)] = std::move(receiver);
    }
    bool handle(std::chrono::milliseconds) override {
      if (queue_->empty()) return false;
      const auto [channel, bytes] = std::move(queue_->front());
      queue_->pop_front();
      const auto receiver = receivers_.find(channel);
      if (receiver != receivers_.end()) receiver->second(bytes);
      return true;
    }

   private:
    LossyNetwork& network_;
    std::shared_ptr<Queue> queue_;
    std::map<std::string, Receiver> receivers_;
  };

  bool chance(double probability) {
    return std::uniform_real_distribution<double>(0.0, 1.0)(dice_) < probability;
  }

  void send(const std::string& channel, const Bytes& bytes) {
    published_.emplace_back(channel, bytes);
    for (const auto& queue : queues_) {
      if (chance(faults_.loss)) {
        ++lost_;
        continue;
      }
      for (int copies = chance(faults_.repeat) ? 2 : 1; copies > 0; --copies) {
        if (chance(faults_.overtake)) {
          queue->emplace_front(channel, bytes);
        } else {
          queue->emplace_back(channel, bytes);
        }
      }
    }
  }

  Faults faults_;
  std::mt19937 dice_;
  std::vector<std::shared_ptr<Queue>> queues_;
  std::vector<std::pair<std::string, Bytes>> published_;
  int lost_ = 0;
};

}  // namespace nextview
