#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <string_view>
#include <vector>

#include "lcmtypes/bus.h"
#include "tests/lcmtypes/lossy_network.h"

namespace nextview {

/// Two members of a run on a network of their own.
class BusPair : public testing::Test {
 protected:
  explicit BusPair(const LossyNetwork::Faults& faults = {}) : network_(faults) {}

  void settle() {
    while (planner_.handle(std::chrono::milliseconds(0)) ||
           mapper_.handle(std::chrono::milliseconds(0))) {
    }
  }
  // Everything published on a channel, by whomever.
  std::vector<LossyNetwork::Bytes> on_channel(std::string_view channel) const {
    std::vector<LossyNetwork::Bytes> result;
    for (const auto& [name, bytes] : network_.published()) {
      if (name == channel) result.push_back(bytes);
    }
    return result;
  }

  LossyNetwork network_;
  Bus planner_{network_.connect(), 7, "planner"};
  Bus mapper_{network_.connect(), 7, "mapper"};
};

/// The same where half of all messages are lost.
class LossyBusPair : public BusPair {
 protected:
  LossyBusPair() : BusPair({.loss = 0.5, .repeat = 0.2, .overtake = 0.2}) {}
};

}  // namespace nextview
