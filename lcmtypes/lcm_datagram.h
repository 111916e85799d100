#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace nextview {

/// A datagram of LCM's udpm provider that holds a whole message: an 8-byte header, the channel's
/// name and its NUL, then the message.
struct LcmDatagram {
  std::string_view channel;
  std::span<const std::uint8_t> message;
  /// Why it is none, for people; empty when it is one.
  std::string_view refusal;
};

/// Looks at nothing beyond the bytes. A fragment of a larger message is refused unseen: nextview
/// never sends one, and what liblcm up to 1.5.2 does with them can write out of bounds.
LcmDatagram read_lcm_datagram(std::span<const std::uint8_t> bytes);

}  // namespace nextview
