#include "lcmtypes/heard_messages.h"

#include <xxhash.h>

#include <algorithm>

namespace nextview {

HeardMessages::Hash HeardMessages::hash_of(std::span<const std::uint8_t> bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return {hash.high64, hash.low64};
}

HeardMessages::Verdict HeardMessages::judge(std::string_view channel, const MessageKey& key,
                                            std::span<const std::uint8_t> bytes) const {
  const auto found = by_channel_.find(channel);
  if (found == by_channel_.end()) return Verdict::New;
  if (key.view < found->second.from_view) return Verdict::Repeated;
  const auto taken = found->second.hashes.find(key);
  if (taken == found->second.hashes.end()) return Verdict::New;
  return taken->second == hash_of(bytes) ? Verdict::Repeated : Verdict::Different;
}

void HeardMessages::take(std::string_view channel, const MessageKey& key,
                         std::span<const std::uint8_t> bytes) {
  Taken& taken = by_channel_[std::string(channel)];
  if (key.view >= taken.from_view) taken.hashes.insert_or_assign(key, hash_of(bytes));
}

void HeardMessages::forget(std::string_view channel, const MessageKey& key) {
  by_channel_[std::string(channel)].hashes.erase(key);
}

void HeardMessages::ignore_before(std::string_view channel, int view) {
  Taken& taken = by_channel_[std::string(channel)];
  taken.from_view = std::max(taken.from_view, view);
  taken.hashes.erase(taken.hashes.begin(), taken.hashes.lower_bound({taken.from_view, 0, 0}));
}

std::size_t HeardMessages::size() const {
  std::size_t all = 0;
  for (const auto& [channel, taken] : by_channel_) all += taken.hashes.size();
  return all;
}

}  // namespace nextview
