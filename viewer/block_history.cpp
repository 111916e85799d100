#include "viewer/block_history.h"

#include <xxhash.h>

#include <algorithm>

namespace nextview {

void BlockHistory::add(int view, std::uint32_t number,
                       const std::array<std::int16_t, 3>& coordinate,
                       std::span<const std::uint8_t> surface) {
  const auto known = place_of_number_.find(number);
  if (known == place_of_number_.end() && surface.empty()) return;
  const std::uint64_t hash = XXH3_64bits(surface.data(), surface.size());
  if (known == place_of_number_.end()) {
    place_of_number_.emplace(number, static_cast<std::uint32_t>(blocks_.size()));
    blocks_.push_back({coordinate, ~hash, {}});
  }
  Block& block = blocks_[place_of_number_.at(number)];
  if (block.hash == hash) return;
  block.hash = hash;
  const Spilled spilled = file_.append(surface);
  block.versions.push_back({spilled.offset, spilled.bytes, view});
}

const BlockHistory::Version* BlockHistory::version(std::size_t block, int view) const {
  const std::vector<Version>& versions = blocks_[block].versions;
  const auto after =
      std::upper_bound(versions.begin(), versions.end(), view,
                       [](int at, const Version& version) { return at < version.view; });
  return after == versions.begin() ? nullptr : &*std::prev(after);
}

int BlockHistory::since(std::size_t block, int view) const {
  const Version* found = version(block, view);
  return found == nullptr ? 0 : found->view;
}

std::size_t BlockHistory::bytes(std::size_t block, int view) const {
  const Version* found = version(block, view);
  return found == nullptr ? 0 : found->bytes;
}

void BlockHistory::read(std::size_t block, int view, std::vector<std::uint8_t>& out) const {
  if (const Version* found = version(block, view)) {
    file_.read({found->offset, found->bytes}, out);
  }
}

std::size_t BlockHistory::memory_bytes() const {
  // A node of the hash table takes about 32 bytes.
  std::size_t bytes = blocks_.capacity() * sizeof(Block) + blocks_.size() * 32;
  for (const Block& block : blocks_) bytes += block.versions.capacity() * sizeof(Version);
  return bytes;
}

}  // namespace nextview
