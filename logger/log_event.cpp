#include "logger/log_event.h"

#include <limits>

namespace nextview {
namespace {

// LCM's own limit is 63; anything near it may come from a library with another one.
constexpr std::uint64_t kLongestChannel = 255;
constexpr std::uint64_t kLongestData = std::numeric_limits<std::int32_t>::max();

std::uint64_t big_endian(std::span<const std::uint8_t> bytes) {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8 | byte;
  return value;
}

void put_big_endian(std::vector<std::uint8_t>& bytes, std::uint64_t value, int count) {
  for (int i = count - 1; i >= 0; --i) {
    bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i) & 0xFF));
  }
}

}  // namespace

bool starts_with_sync_word(std::span<const std::uint8_t> bytes) {
  return big_endian(bytes.first(kSyncWordBytes)) == kSyncWord;
}

std::optional<EventHeader> event_header(std::span<const std::uint8_t> bytes) {
  if (!starts_with_sync_word(bytes)) return std::nullopt;
  const std::uint64_t channel_bytes = big_endian(bytes.subspan(20, 4));
  const std::uint64_t data_bytes = big_endian(bytes.subspan(24, 4));
  if (channel_bytes > kLongestChannel || data_bytes > kLongestData) return std::nullopt;
  EventHeader header;
  header.number = big_endian(bytes.subspan(4, 8));
  header.received_us = static_cast<std::int64_t>(big_endian(bytes.subspan(12, 8)));
  header.channel_bytes = channel_bytes;
  header.data_bytes = data_bytes;
  return header;
}

std::vector<std::uint8_t> encode_event(EventHeader header, std::string_view channel,
                                       std::span<const std::uint8_t> data) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(kEventHeaderBytes + channel.size() + data.size());
  put_big_endian(bytes, kSyncWord, 4);
  put_big_endian(bytes, header.number, 8);
  put_big_endian(bytes, static_cast<std::uint64_t>(header.received_us), 8);
  put_big_endian(bytes, channel.size(), 4);
  put_big_endian(bytes, data.size(), 4);
  bytes.insert(bytes.end(), channel.begin(), channel.end());
  bytes.insert(bytes.end(), data.begin(), data.end());
  return bytes;
}

}  // namespace nextview
