#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nextview/arrival_t.hpp>
#include <nextview/commit_t.hpp>
#include <nextview/goal_t.hpp>
#include <nextview/range_image_t.hpp>
#include <nextview/request_t.hpp>
#include <nextview/run_config_t.hpp>
#include <nextview/search_t.hpp>
#include <nextview/status_t.hpp>
#include <nextview/stop_t.hpp>
#include <string_view>

namespace nextview {

/// The largest message anybody publishes: what a socket's buffer takes several of on one host.
constexpr std::size_t kMaxMessageBytes = 60 * 1024;

/// The largest raster, columns and rows added up: its ray table, which every part of a range image
/// carries, then takes half of a message at most.
constexpr int kMaxColumnsAndRows = 1920;

/// What tells the messages of one channel of one run apart.
struct MessageKey {
  std::int32_t view = 0;     ///< 0 for messages that belong to no view
  std::int32_t attempt = 0;  ///< likewise
  std::int32_t part = 0;     ///< of a range image
  auto operator<=>(const MessageKey&) const = default;
};

/// An array length in an encoded message, and what each unit of it adds to the message's size.
struct LengthField {
  std::size_t offset;             ///< of the big-endian int32 in the received bytes
  std::size_t bytes_per_element;  ///< of all arrays of this length together
};

/// The channel table: one channel for each message type, and the other way round. Each entry has
///   name      the channel
///   answered  whether what was published is kept and sent again, unchanged, to whoever asks
///   lengths   the array lengths of the encoded message, all of them at fixed offsets at its front
///   strings   how many strings it has, all of them side by side ...
///   tail      ... followed by this many bytes
/// With these the exact size of a message is known before the generated code decodes it. The
/// generated code believes lengths and crashes on wrong ones.
template <class Message>
struct Channel;

namespace channel_detail {
/// Every encoded message begins with an int64 fingerprint and an int64 utime.
constexpr std::size_t kFirstLength = 16;
using NoLengths = std::array<LengthField, 0>;
}  // namespace channel_detail

template <>
struct Channel<run_config_t> {
  static constexpr std::string_view name = "NEXTVIEW_RUN_CONFIG";
  static constexpr bool answered = true;
  static constexpr channel_detail::NoLengths lengths = {};
  static constexpr int strings = 5;
  static constexpr std::size_t tail = 0;
};

template <>
struct Channel<goal_t> {
  static constexpr std::string_view name = "NEXTVIEW_GOAL";
  static constexpr bool answered = true;
  static constexpr std::array<LengthField, 1> lengths = {{{channel_detail::kFirstLength, 24}}};
  static constexpr int strings = 0;
  static constexpr std::size_t tail = 0;
};

template <>
struct Channel<search_t> {
  static constexpr std::string_view name = "NEXTVIEW_SEARCH";
  static constexpr bool answered = true;
  static constexpr std::array<LengthField, 1> lengths = {{{channel_detail::kFirstLength, 49}}};
  static constexpr int strings = 0;
  static constexpr std::size_t tail = 0;
};

template <>
struct Channel<arrival_t> {
  static constexpr std::string_view name = "NEXTVIEW_ARRIVAL";
  static constexpr bool answered = true;
  static constexpr channel_detail::NoLengths lengths = {};
  static constexpr int strings = 1;
  static constexpr std::size_t tail = 0;
};

template <>
struct Channel<range_image_t> {
  static constexpr std::string_view name = "NEXTVIEW_RANGE_IMAGE";
  static constexpr bool answered = true;
  static constexpr std::array<LengthField, 3> lengths = {
      {{channel_detail::kFirstLength, 16},       // columns: a sine and a cosine each
       {channel_detail::kFirstLength + 4, 16},   // rows: likewise
       {channel_detail::kFirstLength + 8, 4}}};  // pixels: a float range each
  static constexpr int strings = 0;
  static constexpr std::size_t tail = 0;
};

template <>
struct Channel<commit_t> {
  static constexpr std::string_view name = "NEXTVIEW_COMMIT";
  static constexpr bool answered = true;
  static constexpr channel_detail::NoLengths lengths = {};
  static constexpr int strings = 1;
  static constexpr std::size_t tail = 16;  // two wall-clock times
};

template <>
struct Channel<stop_t> {
  static constexpr std::string_view name = "NEXTVIEW_STOP";
  static constexpr bool answered = true;
  static constexpr channel_detail::NoLengths lengths = {};
  static constexpr int strings = 2;
  static constexpr std::size_t tail = 0;
};

/// Published afresh by whoever is asked, so never kept.
template <>
struct Channel<status_t> {
  static constexpr std::string_view name = "NEXTVIEW_STATUS";
  static constexpr bool answered = false;
  static constexpr channel_detail::NoLengths lengths = {};
  static constexpr int strings = 2;
  static constexpr std::size_t tail = 0;
};

template <>
struct Channel<request_t> {
  static constexpr std::string_view name = "NEXTVIEW_REQUEST";
  static constexpr bool answered = false;
  static constexpr channel_detail::NoLengths lengths = {};
  static constexpr int strings = 2;
  static constexpr std::size_t tail = 0;
};

/// Calls f.template operator()<Message>() for every type of the table: for whoever handles all
/// channels alike, as the reader of a log does.
template <class F>
void for_each_channel(F&& f) {
  f.template operator()<run_config_t>();
  f.template operator()<goal_t>();
  f.template operator()<search_t>();
  f.template operator()<arrival_t>();
  f.template operator()<range_image_t>();
  f.template operator()<commit_t>();
  f.template operator()<stop_t>();
  f.template operator()<status_t>();
  f.template operator()<request_t>();
}

/// The key of a message; a request has the key of what it asks for.
template <class Message>
MessageKey key_of(const Message& message) {
  MessageKey key;
  if constexpr (requires { message.view; }) key.view = message.view;
  if constexpr (requires { message.attempt; }) key.attempt = message.attempt;
  if constexpr (requires { message.part; }) key.part = message.part;
  return key;
}

}  // namespace nextview
