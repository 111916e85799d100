#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "mapper/lazy_pages.h"

namespace nextview {

/// An array whose entries begin with one value, and of which only the pages that are written to
/// take memory: an entry for every voxel of a workspace costs what has been seen of it. Entries are
/// to be read wherever needed and written only where they change.
template <class T>
class LazyArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  LazyArray() = default;
  /// @param value of which the entries are copies to begin with; other than all zeros only of types
  ///        whose size is a power of two
  explicit LazyArray(std::size_t size, const T& value = T()) {
    const LazyPages::Stretch all{bytes_of(value), size * sizeof(T)};
    pages_ = LazyPages(std::span(&all, 1));
  }
  /// What begins with several.
  explicit LazyArray(std::span<const LazyPages::Stretch> stretches) : pages_(stretches) {}

  T& operator[](std::size_t n) { return data()[n]; }
  const T& operator[](std::size_t n) const { return data()[n]; }
  T* data() { return reinterpret_cast<T*>(pages_.data()); }
  const T* data() const { return reinterpret_cast<const T*>(pages_.data()); }
  T* begin() { return data(); }
  const T* begin() const { return data(); }
  T* end() { return data() + size(); }
  const T* end() const { return data() + size(); }
  std::size_t size() const { return pages_.size() / sizeof(T); }
  operator std::span<const T>() const { return {data(), size()}; }

  std::size_t memory_bytes() const { return pages_.memory_bytes(); }

 private:
  static std::vector<std::byte> bytes_of(const T& value) {
    std::vector<std::byte> bytes(sizeof(T));
    std::memcpy(bytes.data(), &value, sizeof(T));
    return bytes;
  }

  LazyPages pages_;
};

}  // namespace nextview
