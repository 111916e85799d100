#include "lcmtypes/heard_messages.h"

#include <xxhash.h>

namespace nextview {

HeardMessages::Hash HeardMessages::hash_of(std::span<const std::uint8_t> bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return {hash.high64, hash.low64};
}

HeardMessages::Verdict HeardMessages::judge(std::string_view channel, const MessageKey& key,
                                            std::span<const std::uint8_t> bytes) const {
  const auto messages = by_channel_.find(channel);
  if (messages == by_channel_.end()) return Verdict::New;
  const auto taken = messages->second.find(key);
  if (taken == messages->second.end()) return Verdict::New;
  return taken->second == hash_of(bytes) ? Verdict::Repeated : Verdict::Different;
}

void HeardMessages::take(std::string_view channel, const MessageKey& key,
                         std::span<const std::uint8_t> bytes) {
  by_channel_[std::string(channel)].insert_or_assign(key, hash_of(bytes));
}

}  // namespace nextview
