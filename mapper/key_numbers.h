#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace nextview {

/// Numbers 64-bit keys 0, 1, 2 ... in the order in which they first come. A hash table by open
/// addressing that stays at most half full; cleared and used again it keeps its memory.
class KeyNumbers {
 public:
  /// Forgets all keys. The table then has room for so many at least before it has to grow.
  void clear(std::size_t expected);

  /// The key's number; size() before the call when it is new.
  std::uint32_t number_of(std::uint64_t key) {
    if (2 * keys_.size() >= table_.size()) grow();
    std::uint32_t& number = table_[place_of(key)];
    if (number == kNone) {
      number = static_cast<std::uint32_t>(keys_.size());
      keys_.push_back(key);
    }
    return number;
  }

  std::size_t size() const { return keys_.size(); }
  std::size_t memory_bytes() const {
    return keys_.capacity() * sizeof(std::uint64_t) + table_.capacity() * sizeof(std::uint32_t);
  }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  /// The place of the table where a key's number is or, if it has none, belongs: from the top bits
  /// of its product with the golden ratio on.
  std::size_t place_of(std::uint64_t key) const {
    const std::size_t mask = table_.size() - 1;
    std::size_t place = static_cast<std::size_t>(key * 0x9e3779b97f4a7c15u >> shift_);
    while (table_[place] != kNone && keys_[table_[place]] != key) place = (place + 1) & mask;
    return place;
  }
  void resize_table(std::size_t places);
  void grow();

  std::vector<std::uint64_t> keys_;   ///< by number
  std::vector<std::uint32_t> table_;  ///< numbers; its size is a power of two
  int shift_ = 0;                     ///< 64 less that power
};

}  // namespace nextview
