#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nextview {

/// Where bytes lie in a SpillFile.
struct Spilled {
  std::uint64_t offset = 0;
  std::uint32_t bytes = 0;  ///< 0: nothing
};

/// A file without a name, in TMPDIR or else /var/tmp, for what is too much to hold in memory. It is
/// gone with the process, however that ends.
class SpillFile {
 public:
  /// @throws std::runtime_error naming the folder when no file can be made there
  SpillFile();
  SpillFile(const SpillFile&) = delete;
  SpillFile& operator=(const SpillFile&) = delete;
  ~SpillFile();

  /// @throws std::runtime_error when the disk is full
  Spilled append(std::span<const std::uint8_t> bytes);
  /// Appends what was appended to `out`.
  /// @throws std::runtime_error when it cannot be read
  void read(const Spilled& spilled, std::vector<std::uint8_t>& out) const;

  std::uint64_t size() const { return size_; }

 private:
  int file_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace nextview
