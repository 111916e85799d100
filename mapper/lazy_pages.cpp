#include "mapper/lazy_pages.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <new>
#include <utility>

namespace nextview {

namespace {

/// A pattern is mapped at most so many times: the system keeps a list of mappings.
constexpr std::size_t kMostRepeats = 256;
constexpr std::size_t kLeastRepeated = 64 * 1024;

std::size_t page_size() {
  static const auto size = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return size;
}

std::size_t whole_pages(std::size_t bytes) {
  return (bytes + page_size() - 1) / page_size() * page_size();
}

bool is_zero(const std::vector<std::byte>& pattern) {
  return std::ranges::all_of(pattern, [](std::byte byte) { return byte == std::byte{0}; });
}

void copy_repeated(const std::vector<std::byte>& pattern, std::byte* to, std::size_t bytes) {
  for (std::size_t at = 0; at < bytes; at += pattern.size()) {
    std::copy_n(pattern.begin(), std::min(pattern.size(), bytes - at), to + at);
  }
}

std::byte* reserve(std::size_t bytes) {
  void* const at = mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                        MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (at == MAP_FAILED) throw std::bad_alloc();
  // A huge page would take memory for what lies far from what was written.
  madvise(at, bytes, MADV_NOHUGEPAGE);
  return static_cast<std::byte*>(at);
}

/// A file in memory.
class MemoryFile {
 public:
  explicit MemoryFile(const std::vector<std::byte>& content)
      : descriptor_(memfd_create("nextview_pattern", MFD_CLOEXEC)) {
    std::size_t written = 0;
    while (is_good() && written < content.size()) {
      const ssize_t more = write(descriptor_, &content[written], content.size() - written);
      if (more <= 0) {
        close(std::exchange(descriptor_, -1));
      } else {
        written += static_cast<std::size_t>(more);
      }
    }
  }
  ~MemoryFile() {
    if (is_good()) close(descriptor_);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  bool is_good() const { return descriptor_ >= 0; }
  void map_at(std::byte* at, std::size_t bytes) const {
    if (mmap(at, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_FIXED | MAP_NORESERVE,
             descriptor_, 0) == MAP_FAILED) {
      throw std::bad_alloc();
    }
  }

 private:
  int descriptor_;
};

}  // namespace

LazyPages::LazyPages(std::span<const Stretch> stretches) {
  bool are_whole_pages = true;
  for (const Stretch& stretch : stretches) {
    are_whole_pages &= size_ % page_size() == 0;
    size_ += stretch.bytes;
  }
  if (are_whole_pages && size_ >= kLeastBytes) {
    map(stretches);
  } else {
    fill(stretches);
  }
}

void LazyPages::fill(std::span<const Stretch> stretches) {
  filled_.resize(size_);
  begin_ = filled_.data();
  std::byte* to = begin_;
  for (const Stretch& stretch : stretches) {
    if (!is_zero(stretch.pattern)) copy_repeated(stretch.pattern, to, stretch.bytes);
    to += stretch.bytes;
  }
}

void LazyPages::map(std::span<const Stretch> stretches) {
  begin_ = reserve(whole_pages(size_));
  mapped_ = whole_pages(size_);
  std::byte* to = begin_;
  for (const Stretch& stretch : stretches) {
    if (!is_zero(stretch.pattern)) repeat(stretch, to);
    to += stretch.bytes;
  }
}

void LazyPages::repeat(const Stretch& stretch, std::byte* to) {
  const std::size_t least = std::max(stretch.bytes / kMostRepeats, kLeastRepeated);
  std::vector<std::byte> pattern(std::max(std::bit_ceil(least), stretch.pattern.size()));
  copy_repeated(stretch.pattern, pattern.data(), pattern.size());
  const MemoryFile file(pattern);
  if (!file.is_good()) {  // without such files it takes all its memory at once
    copy_repeated(stretch.pattern, to, stretch.bytes);
    return;
  }
  pattern_bytes_ += pattern.size();
  for (std::size_t at = 0; at < stretch.bytes; at += pattern.size()) {
    file.map_at(to + at, whole_pages(std::min(pattern.size(), stretch.bytes - at)));
  }
}

LazyPages::~LazyPages() {
  if (mapped_ > 0) munmap(begin_, mapped_);
}

LazyPages::LazyPages(LazyPages&& other) noexcept { *this = std::move(other); }

LazyPages& LazyPages::operator=(LazyPages&& other) noexcept {
  std::swap(begin_, other.begin_);
  std::swap(size_, other.size_);
  std::swap(mapped_, other.mapped_);
  std::swap(pattern_bytes_, other.pattern_bytes_);
  std::swap(filled_, other.filled_);
  return *this;
}

std::size_t LazyPages::memory_bytes() const {
  if (mapped_ == 0) return filled_.capacity();
  constexpr std::uint64_t kOurs = std::uint64_t{1} << 56 | std::uint64_t{1} << 62;  // or swapped
  const int file = open("/proc/self/pagemap", O_RDONLY | O_CLOEXEC);
  if (file < 0) return mapped_;
  std::vector<std::uint64_t> entries(mapped_ / page_size());
  const auto bytes = static_cast<ssize_t>(entries.size() * sizeof(entries[0]));
  const auto at = static_cast<off_t>(reinterpret_cast<std::uintptr_t>(begin_) / page_size() *
                                     sizeof(entries[0]));
  const bool is_read = pread(file, entries.data(), static_cast<std::size_t>(bytes), at) == bytes;
  close(file);
  if (!is_read) return mapped_;
  const auto written =
      std::ranges::count_if(entries, [](std::uint64_t entry) { return (entry & kOurs) != 0; });
  return static_cast<std::size_t>(written) * page_size() + pattern_bytes_;
}

}  // namespace nextview
