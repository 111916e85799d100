#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "sensor/range_image_message.h"

namespace nextview {

/// How much of a range image a part carries that travels in one IP packet of 1500 bytes with LCM's
/// header, the channel's name and the part's description, and some to spare for tunnels; a multiple
/// of what an entry of the ray table takes, so that every part but the last is full.
constexpr std::size_t kPacketPartBytes = 1152;

/// How much a part carries on a bus: a packet where packets can be lost one by one, which is where
/// the bus leaves the host (ttl of at least 1), for of a larger message all is lost with any of its
/// packets. On one host a datagram is lost or comes whole, and the fewer the better.
/// @param lcm_url as LCM has it
inline std::size_t part_bytes_on(const std::string& lcm_url) {
  constexpr std::string_view kTtl = "ttl=";
  const std::size_t options = lcm_url.find('?');
  if (options == std::string::npos) return kPartBytes;
  const std::size_t ttl = lcm_url.find(kTtl, options);
  if (ttl == std::string::npos) return kPartBytes;
  const std::size_t digit = lcm_url.find_first_not_of('0', ttl + kTtl.size());
  const bool leaves = digit != std::string::npos && lcm_url[digit] >= '1' && lcm_url[digit] <= '9';
  return leaves ? kPacketPartBytes : kPartBytes;
}

}  // namespace nextview
