#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace nextview {

/// What stands before every event of an LCM log, all big-endian: the sync word, by which a reader
/// finds an event again, then these; after it the channel and the data.
struct EventHeader {
  std::uint64_t number = 0;      ///< from 0, rising by one
  std::int64_t received_us = 0;  ///< by the recorder's clock
  std::size_t channel_bytes = 0;
  std::size_t data_bytes = 0;

  std::size_t event_bytes() const;
};

constexpr std::uint32_t kSyncWord = 0xEDA1DA01;
constexpr std::size_t kSyncWordBytes = 4;
constexpr std::size_t kEventHeaderBytes = 28;

inline std::size_t EventHeader::event_bytes() const {
  return kEventHeaderBytes + channel_bytes + data_bytes;
}

/// @param bytes at least kSyncWordBytes
bool starts_with_sync_word(std::span<const std::uint8_t> bytes);

/// Nothing where no event can start: no sync word, a negative length, or a channel longer than LCM
/// has them.
/// @param bytes at least kEventHeaderBytes
std::optional<EventHeader> event_header(std::span<const std::uint8_t> bytes);

/// An event as it stands in a log; the header's lengths are taken from the two.
std::vector<std::uint8_t> encode_event(EventHeader header, std::string_view channel,
                                       std::span<const std::uint8_t> data);

}  // namespace nextview
