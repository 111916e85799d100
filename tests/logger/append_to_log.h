#pragma once

#include <cstdint>
#include <filesystem>
#include <lcm/lcm-cpp.hpp>
#include <string>
#include <vector>

#include "lcmtypes/decode.h"

namespace nextview {

/// Writes a message at the end of a log, as a recorder does that goes on with it.
template <class Message>
void append_to_log(const std::filesystem::path& log, const Message& message) {
  std::vector<std::uint8_t> bytes = encode(message);
  lcm::LogEvent event{};
  event.channel = std::string(Channel<Message>::name);
  event.data = bytes.data();
  event.datalen = static_cast<int>(bytes.size());
  lcm::LogFile(log.string(), "a").writeEvent(&event);
}

}  // namespace nextview
