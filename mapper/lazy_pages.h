#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace nextview {

/// Bytes that begin with a given content, of which a page takes memory only once it is written to.
///
/// Address space costs nothing: pages that nobody has written to are the system's one page of
/// zeros, or those of one copy of the pattern they begin with, mapped again and again (memfd).
/// Reading is as from any memory. Below kLeastBytes all of it is filled at once: there a page more
/// or less is nothing, and memory that lies there already is a little faster.
class LazyPages {
 public:
  static constexpr std::size_t kLeastBytes = std::size_t{1} << 20;

  /// So many bytes of a pattern repeated, whose size is a power of two.
  struct Stretch {
    std::vector<std::byte> pattern;
    std::size_t bytes = 0;
  };

  LazyPages() = default;
  /// Stretches one after the other. Of several, each but the last should be whole pages, or all is
  /// filled at once.
  /// @throws std::bad_alloc when the system gives no more
  explicit LazyPages(std::span<const Stretch> stretches);
  ~LazyPages();
  LazyPages(LazyPages&& other) noexcept;
  LazyPages& operator=(LazyPages&& other) noexcept;

  std::byte* data() { return begin_; }
  const std::byte* data() const { return begin_; }
  std::size_t size() const { return size_; }
  /// Of the pages that have been written to, and of the patterns; all, where the system does not
  /// tell (/proc/self/pagemap).
  std::size_t memory_bytes() const;

 private:
  void map(std::span<const Stretch> stretches);
  void fill(std::span<const Stretch> stretches);
  void repeat(const Stretch& stretch, std::byte* to);

  std::byte* begin_ = nullptr;
  std::size_t size_ = 0;
  std::size_t mapped_ = 0;         // bytes; 0: all in filled_
  std::size_t pattern_bytes_ = 0;  // of the copies that are mapped
  std::vector<std::byte> filled_;
};

}  // namespace nextview
