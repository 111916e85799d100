#include "logger/log_contents.h"

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string_view>

#include "lcmtypes/decode.h"

namespace nextview {
namespace {

constexpr std::string_view kOurs = "NEXTVIEW_";
// Every program on the bus starts with one; nobody's message.
constexpr std::string_view kSelfTest = "LCM_SELF_TEST";
constexpr std::string_view kSelfTestSays = "lcm self test";
constexpr std::string_view kSeal = Channel<seal_t>::name;

std::string hexadecimal(const XXH128_canonical_t& hash) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : hash.digest) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

std::string digest_of(const std::vector<std::uint8_t>& bytes) {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(bytes.data(), bytes.size()));
  return hexadecimal(canonical);
}

std::vector<std::string> our_channels() {
  std::vector<std::string> names;
  for_each_channel([&]<class Message>() {
    if (Channel<Message>::name != kSeal) names.emplace_back(Channel<Message>::name);
  });
  return names;
}

bool is_known(std::string_view channel) {
  bool known = false;
  for_each_channel([&]<class Message>() { known |= channel == Channel<Message>::name; });
  return known;
}

std::string range_of(std::uint64_t first, std::uint64_t last) {
  if (first == last) return "event " + std::to_string(first) + " is";
  return "events " + std::to_string(first) + " to " + std::to_string(last) + " are";
}

void append(std::string& list, std::string_view item) {
  if (!list.empty()) list += ',';
  list += item;
}

}  // namespace

void LogContents::add(const LoggedMessage& event) {
  if (event.channel == kSeal) {
    const auto seal = event.message();
    if (event.is_authentic()) seals_.push_back({numbers_.size(), {seal.begin(), seal.end()}});
  } else if (event.channel.starts_with(kOurs)) {
    const XXH128_hash_t hash = XXH3_128bits(event.bytes.data(), event.bytes.size());
    messages_[event.channel].emplace_back(hash.high64, hash.low64);
  }
  if (event.channel == kSelfTest && !std::ranges::equal(event.bytes, kSelfTestSays)) {
    ++odd_self_tests_;
  }
  ++events_on_[event.channel];
  numbers_.push_back(event.number);
  times_us_.push_back(event.received_us);
}

void LogContents::add_damage(const std::string& file, const DamagedBytes& damaged) {
  damage_.push_back(file + ": " + std::to_string(damaged.bytes) + " bytes from byte " +
                    std::to_string(damaged.position) + " on are no whole event");
}

LogContents::Tally LogContents::tally_of(const std::string& channel) const {
  const auto found = messages_.find(channel);
  std::vector<Hash> hashes = found == messages_.end() ? std::vector<Hash>() : found->second;
  std::sort(hashes.begin(), hashes.end());
  hashes.erase(std::unique(hashes.begin(), hashes.end()), hashes.end());
  std::vector<std::uint8_t> bytes;
  for (const auto& [high, low] : hashes) {
    XXH128_canonical_t canonical;
    XXH128_canonicalFromHash(&canonical, {low, high});
    bytes.insert(bytes.end(), std::begin(canonical.digest), std::end(canonical.digest));
  }
  return {static_cast<std::int64_t>(hashes.size()), digest_of(bytes)};
}

std::string LogContents::times_digest(std::size_t events) const {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < events; ++i) {
    const auto time = static_cast<std::uint64_t>(times_us_[i]);
    for (int shift = 56; shift >= 0; shift -= 8) {
      bytes.push_back(static_cast<std::uint8_t>(time >> shift & 0xFF));
    }
  }
  return digest_of(bytes);
}

seal_t LogContents::seal(std::int64_t run, std::int64_t utime) const {
  seal_t seal{};
  seal.utime = utime;
  seal.run = run;
  for (const std::string& channel : our_channels()) {
    const Tally tally = tally_of(channel);
    seal.distinct_messages.push_back(tally.distinct);
    append(seal.channel_names, channel);
    append(seal.channel_digests, tally.digest);
  }
  seal.sealed_channels = static_cast<std::int32_t>(seal.distinct_messages.size());
  seal.times_digest = times_digest(numbers_.size());
  return seal;
}

bool LogContents::is_sealed(std::int64_t run) const {
  return std::any_of(seals_.begin(), seals_.end(), [run](const LoggedSeal& logged) {
    const auto seal = decode_checked<seal_t>(logged.bytes).message;
    return seal && seal->run == run;
  });
}

LogFaults LogContents::faults(std::int64_t run, std::optional<std::int64_t> end_utime) const {
  LogFaults faults;
  faults.missing = damage_;
  check_numbers(faults);
  check_seals(run, end_utime, faults);
  check_channels(faults);
  return faults;
}

void LogContents::check_channels(LogFaults& faults) const {
  for (const auto& [channel, events] : events_on_) {
    if (is_known(channel) || channel == kSelfTest) continue;
    const std::string messages =
        std::to_string(events) + (events == 1 ? " message on " : " messages on ") + channel;
    if (channel.starts_with(kOurs)) {
      faults.missing.push_back("what is said by " + messages +
                               ", a channel that this version does not know");
    } else {
      faults.remarks.push_back("there is also " + messages + ", which no run has to do with");
    }
  }
  if (odd_self_tests_ > 0) {
    faults.remarks.push_back("there is also a message on LCM_SELF_TEST that is not LCM's");
  }
}

/// A recorder numbers from 0 on, as does another one that goes on with a log, or with its next
/// file.
void LogContents::check_numbers(LogFaults& faults) const {
  std::uint64_t expected = 0;
  std::set<std::uint64_t> early;
  const auto out_of_order = [&](std::size_t place, std::uint64_t number) {
    faults.differences.push_back("event " + std::to_string(place) + " of the log has the number " +
                                 std::to_string(number) + " where " + std::to_string(expected) +
                                 " should stand");
  };
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    const std::uint64_t number = numbers_[i];
    if (number == 0 && early.empty()) {
      if (i > 0) {
        faults.remarks.push_back("event " + std::to_string(i) +
                                 " of the log is numbered 0 again: another recorder's, the next "
                                 "file's, or there twice");
      }
      expected = 1;
      continue;
    }
    if (number < expected) {
      out_of_order(i, number);
      continue;
    }
    if (number > expected) {
      const std::optional<std::uint64_t> next =
          i + 1 < numbers_.size() ? std::optional(numbers_[i + 1]) : std::nullopt;
      if (next == expected) {  // the two are swapped
        out_of_order(i, number);
        early.insert(number);
        continue;
      }
      if (next == expected + 1) {  // the number itself is damaged
        out_of_order(i, number);
        ++expected;
        continue;
      }
      faults.missing.push_back(range_of(expected, number - 1) + " not in the log, by its numbers");
      expected = number;
    }
    ++expected;
    while (early.erase(expected) > 0) ++expected;
  }
}

void LogContents::check_seals(std::int64_t run, std::optional<std::int64_t> end_utime,
                              LogFaults& faults) const {
  for (const LoggedSeal& logged : seals_) {
    const auto decoded = decode_checked<seal_t>(logged.bytes);
    if (!decoded.message) {
      faults.missing.push_back("a seal that can be read: " + decoded.reason);
    } else if (decoded.message->run != run) {
      faults.remarks.push_back("the log bears the seal of another run, " +
                               std::to_string(decoded.message->run));
    } else {
      faults.sealed = true;
      check_seal(*decoded.message, logged.events_before, faults);
      if (end_utime && decoded.message->utime != *end_utime) {
        faults.differences.push_back("the seal is not of the time at which the run ended");
      }
    }
  }
}

void LogContents::check_seal(const seal_t& seal, std::size_t events_before,
                             LogFaults& faults) const {
  const std::vector<std::string_view> names = names_of(seal.channel_names);
  const std::vector<std::string_view> digests = names_of(seal.channel_digests);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string channel(names[i]);
    const std::int64_t sealed = seal.distinct_messages[i];
    if (!is_known(channel)) {
      faults.missing.push_back("what the seal says of " + channel +
                               ", a channel that this version does not know");
    }
    const Tally there = tally_of(channel);
    if (there.digest == digests[i] && there.distinct == sealed) continue;
    const std::string counts = std::to_string(sealed) + " messages on " + channel +
                               " were sealed, " + std::to_string(there.distinct) +
                               (there.distinct == 1 ? " is" : " are") + " there";
    if (there.distinct < sealed) {
      faults.missing.push_back(counts);
    } else {
      faults.differences.push_back(counts + ", and not all are what they were");
    }
  }
  for (const auto& [channel, messages] : messages_) {
    if (std::find(names.begin(), names.end(), channel) != names.end() || !is_known(channel)) {
      continue;
    }
    faults.differences.push_back("the seal knows of no messages on " + channel);
  }
  const bool own_time =
      events_before == 0 || times_us_[events_before] == times_us_[events_before - 1];
  if (times_digest(events_before) != seal.times_digest || !own_time) {
    faults.remarks.push_back(
        "events were received at other times than when the log was sealed (recorded anew, or their "
        "headers were changed); nothing depends on it");
  }
}

}  // namespace nextview
