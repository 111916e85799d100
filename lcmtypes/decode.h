#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lcmtypes/channels.h"
#include "lcmtypes/validate.h"

namespace nextview {

/// A message, or one line saying why the received bytes cannot be one.
template <class Message>
struct Decoded {
  std::optional<Message> message;
  std::string reason;  ///< empty when there is a message
};

/// What the size check needs to know of a type; see Channel.
struct MessageLayout {
  std::int64_t fingerprint;
  std::span<const LengthField> lengths;
  std::size_t smallest_bytes;  ///< encoded, with empty arrays and empty strings
  int strings;
};

/// Checks fingerprint, array lengths, string lengths and total size without decoding.
/// @return empty when the generated decoder can be let loose on the bytes, else the reason
std::string check_layout(const MessageLayout& layout, std::span<const std::uint8_t> bytes);

/// check_layout of a type.
template <class Message>
std::string wrong_layout(std::span<const std::uint8_t> bytes) {
  using Table = Channel<Message>;
  return check_layout({Message::getHash(), Table::lengths,
                       static_cast<std::size_t>(Message{}.getEncodedSize()), Table::strings},
                      bytes);
}

/// The one way from received or logged bytes to a message. Allocates no more than a small multiple
/// of what was received, whatever the bytes say, and never throws on bad bytes.
template <class Message>
Decoded<Message> decode_checked(std::span<const std::uint8_t> bytes) {
  Decoded<Message> result;
  result.reason = wrong_layout<Message>(bytes);
  if (!result.reason.empty()) return result;
  Message message{};
  const int size = static_cast<int>(bytes.size());
  if (message.decode(bytes.data(), 0, size) != size) {
    result.reason = "does not decode";
    return result;
  }
  result.reason = check(message);
  if (result.reason.empty()) result.message = std::move(message);
  return result;
}

/// The bytes of a message as they travel and as they are logged.
template <class Message>
std::vector<std::uint8_t> encode(const Message& message);

}  // namespace nextview
