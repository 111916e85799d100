#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "lcmtypes/channels.h"

namespace nextview {

/// The messages that have been taken, by channel and key: of each only a hash of its bytes.
class HeardMessages {
 public:
  enum class Verdict { New, Repeated, Different };

  /// What a message is, given the one that was taken under its key.
  Verdict judge(std::string_view channel, const MessageKey& key,
                std::span<const std::uint8_t> bytes) const;
  void take(std::string_view channel, const MessageKey& key, std::span<const std::uint8_t> bytes);
  void forget(std::string_view channel, const MessageKey& key);
  /// From now on messages of the views before this one are all repeated, and nothing is remembered
  /// of them.
  void ignore_before(std::string_view channel, int view);
  /// How many are remembered.
  std::size_t size() const;

 private:
  using Hash = std::pair<std::uint64_t, std::uint64_t>;
  static Hash hash_of(std::span<const std::uint8_t> bytes);

  struct Taken {
    int from_view = 0;
    std::map<MessageKey, Hash> hashes;
  };
  std::map<std::string, Taken, std::less<>> by_channel_;
};

}  // namespace nextview
