#include "runner/disk_room.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <vector>

#include "lcmtypes/channels.h"
#include "runner/file_descriptor.h"

namespace nextview {

std::optional<std::string> why_no_more_fits(const std::filesystem::path& file) {
  rlimit limit{};
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(file, unknown);
  if (!unknown && ::getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
      size + kMaxMessageBytes > limit.rlim_cur) {
    return std::strerror(EFBIG);
  }
  std::string other = (file.parent_path() / ".room-XXXXXX").string();
  const FileDescriptor probe(::mkostemp(other.data(), O_CLOEXEC));
  if (!probe) return std::strerror(errno);
  const std::vector<char> bytes(kMaxMessageBytes);
  std::size_t written = 0;
  ssize_t count = 0;
  while (written < bytes.size()) {
    count = ::write(probe.get(), bytes.data(), bytes.size() - written);
    if (count <= 0) break;
    written += static_cast<std::size_t>(count);
  }
  const int error = errno;
  ::unlink(other.c_str());
  if (written == bytes.size()) return std::nullopt;
  return std::strerror(error);
}

}  // namespace nextview
