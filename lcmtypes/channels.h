#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nextview/arrival_t.hpp>
#include <nextview/commit_t.hpp>
#include <nextview/goal_t.hpp>
#include <nextview/map_blocks_t.hpp>
#include <nextview/pace_t.hpp>
#include <nextview/parts_request_t.hpp>
#include <nextview/range_image_t.hpp>
#include <nextview/recorded_t.hpp>
#include <nextview/request_t.hpp>
#include <nextview/run_config_t.hpp>
#include <nextview/search_t.hpp>
#include <nextview/status_t.hpp>
#include <nextview/stop_t.hpp>
#include <nextview/timing_t.hpp>
#include <string_view>

namespace nextview {

/// The largest message anybody publishes: what a socket's buffer takes several of on one host.
constexpr std::size_t kMaxMessageBytes = 60 * 1024;

/// A list of types.
template <class... Types>
struct TypeList {
  static constexpr std::size_t size = sizeof...(Types);
};

/// Every type of message. Whoever handles all of them goes by this list: for_each_channel, the
/// encoder, the tests of every type. A test holds it against the .lcm files of this folder.
using AllMessages =
    TypeList<run_config_t, goal_t, search_t, arrival_t, range_image_t, commit_t, stop_t, status_t,
             request_t, timing_t, map_blocks_t, pace_t, parts_request_t, recorded_t>;

/// What tells the messages of one channel of one run apart.
struct MessageKey {
  std::int32_t view = 0;     ///< 0 for messages that belong to no view
  std::int32_t attempt = 0;  ///< likewise
  std::int32_t part = 0;     ///< of a range image, or of blocks of the map
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
///   strings   how many strings it has, all of them side by side at its end
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
  static constexpr int strings = 6;
};

template <>
struct Channel<goal_t> {
  static constexpr std::string_view name = "NEXTVIEW_GOAL";
  static constexpr bool answered = true;
  static constexpr std::array<LengthField, 2> lengths = {
      {{channel_detail::kFirstLength, 24},       // waypoints
       {channel_detail::kFirstLength + 4, 8}}};  // factors
  static constexpr int strings = 3;
};

template <>
struct Channel<search_t> {
  static constexpr std::string_view name = "NEXTVIEW_SEARCH";
  static constexpr bool answered = true;
  static constexpr std::array<LengthField, 1> lengths = {{{channel_detail::kFirstLength, 49}}};
  static constexpr int strings = 0;
};

template <>
struct Channel<arrival_t> {
  static constexpr std::string_view name = "NEXTVIEW_ARRIVAL";
  static constexpr bool answered = true;
  static constexpr channel_detail::NoLengths lengths = {};
  static constexpr int strings = 1;
};

template <>
struct Channel<range_image_t> {
  static constexpr std::string_view name = "NEXTVIEW_RANGE_IMAGE";
  static constexpr bool answered = true;
  static constexpr std::array<LengthField, 2> lengths = {
      {{channel_detail::kFirstLength, 16},       // entries: a sine and a cosine each
       {channel_detail::kFirstLength + 4, 4}}};  // pixels: a float range each
  static constexpr int strings = 0;
};

template <>
struct Channel<commit_t> {
  static constexpr std::string_view name = "NEXTVIEW_COMMIT";
  static constexpr bool answered = true;
  static constexpr channel_detail::NoLengths lengths = {};
  static constexpr int strings = 2;
};

template <>
struct Channel<stop_t> {
  static constexpr std::string_view name = "NEXTVIEW_STOP";
  static constexpr bool answered = true;
  static constexpr channel_detail::NoLengths lengths = {};
  static constexpr int strings = 2;
};

/// Published afresh by whoever is asked, so never kept.
template <>
struct Channel<status_t> {
  static constexpr std::string_view name = "NEXTVIEW_STATUS";
  static constexpr bool answered = false;
  static constexpr channel_detail::NoLengths lengths = {};
  static constexpr int strings = 3;
};

template <>
struct Channel<request_t> {
  static constexpr std::string_view name = "NEXTVIEW_REQUEST";
  static constexpr bool answered = false;
  static constexpr channel_detail::NoLengths lengths = {};
  static constexpr int strings = 2;
};

/// For people only: a lost one is not missed.
template <>
struct Channel<timing_t> {
  static constexpr std::string_view name = "NEXTVIEW_TIMING";
  static constexpr bool answered = false;
  static constexpr std::array<LengthField, 1> lengths = {{{channel_detail::kFirstLength, 8}}};
  static constexpr int strings = 2;
};

/// Made afresh for whoever asks: what has changed in the map depends on when that is.
template <>
struct Channel<map_blocks_t> {
  static constexpr std::string_view name = "NEXTVIEW_MAP_BLOCKS";
  static constexpr bool answered = false;
  static constexpr std::array<LengthField, 2> lengths = {
      {{channel_detail::kFirstLength, 12 + 512},      // blocks: an index and 512 labels
       {channel_detail::kFirstLength + 4, 12 + 4}}};  // surfaces: a normal and a quality
  static constexpr int strings = 0;
};

/// Published again and again while it matters.
template <>
struct Channel<pace_t> {
  static constexpr std::string_view name = "NEXTVIEW_PACE";
  static constexpr bool answered = false;
  static constexpr channel_detail::NoLengths lengths = {};
  static constexpr int strings = 0;
};

template <>
struct Channel<parts_request_t> {
  static constexpr std::string_view name = "NEXTVIEW_PARTS_REQUEST";
  static constexpr bool answered = false;
  static constexpr std::array<LengthField, 1> lengths = {{{channel_detail::kFirstLength, 8}}};
  static constexpr int strings = 2;
};

/// Published again whenever there is more.
template <>
struct Channel<recorded_t> {
  static constexpr std::string_view name = "NEXTVIEW_RECORDED";
  static constexpr bool answered = false;
  static constexpr channel_detail::NoLengths lengths = {};
  static constexpr int strings = 0;
};

namespace channel_detail {
template <class F, class... Messages>
void for_each(TypeList<Messages...>, F& f) {
  (f.template operator()<Messages>(), ...);
}
}  // namespace channel_detail

/// Calls f.template operator()<Message>() for every type of the table: for whoever handles all
/// channels alike, as the reader of a log does.
template <class F>
void for_each_channel(F&& f) {
  channel_detail::for_each(AllMessages{}, f);
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
