#include "viewer/spill_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

namespace nextview {
namespace {

/// /tmp may lie in memory, /var/tmp does not.
std::string folder() {
  const char* named = std::getenv("TMPDIR");
  return named == nullptr || *named == '\0' ? "/var/tmp" : named;
}

}  // namespace

SpillFile::SpillFile() {
  std::string name = folder() + "/nextview-viewer-XXXXXX";
  file_ = ::mkstemp(name.data());
  if (file_ < 0) {
    throw std::runtime_error(folder() + ": no file can be made there for what has been seen (" +
                             std::strerror(errno) + "); name another folder in TMPDIR");
  }
  ::unlink(name.c_str());
}

SpillFile::~SpillFile() { ::close(file_); }

Spilled SpillFile::append(std::span<const std::uint8_t> bytes) {
  const Spilled spilled{size_, static_cast<std::uint32_t>(bytes.size())};
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(file_, bytes.data(), bytes.size(), static_cast<off_t>(size_));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      throw std::runtime_error(folder() + ": what has been seen cannot be kept (" +
                               std::strerror(errno) + "); name another folder in TMPDIR");
    }
    size_ += static_cast<std::uint64_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return spilled;
}

void SpillFile::read(const Spilled& spilled, std::vector<std::uint8_t>& out) const {
  const std::size_t before = out.size();
  out.resize(before + spilled.bytes);
  std::size_t have = 0;
  while (have < spilled.bytes) {
    const ssize_t got = ::pread(file_, out.data() + before + have, spilled.bytes - have,
                                static_cast<off_t>(spilled.offset + have));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) throw std::runtime_error("what was kept of a run cannot be read back");
    have += static_cast<std::size_t>(got);
  }
}

}  // namespace nextview
