#include "logger/log_reader.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <span>
#include <utility>

#include "logger/log_event.h"

namespace nextview {
/// A file that may grow, seen through a window that is moved over it.
struct LogReader::File {
  explicit File(const std::filesystem::path& file)
      : path(file), descriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (descriptor < 0) throw LogError(path.string() + ": cannot be opened: " + strerror(errno));
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() { ::close(descriptor); }

  std::int64_t size() const {
    struct stat status {};
    return ::fstat(descriptor, &status) == 0 ? std::int64_t{status.st_size} : 0;
  }

  /// The bytes from a position on, up to so many; fewer where the file ends.
  std::span<const std::uint8_t> at(std::int64_t position, std::size_t bytes) {
    const std::int64_t end = position + static_cast<std::int64_t>(bytes);
    const std::int64_t window_end = window_start + static_cast<std::int64_t>(window.size());
    if (position < window_start || end > window_end) read_window(position, bytes);
    const std::span<const std::uint8_t> all(window);
    const auto offset = static_cast<std::size_t>(position - window_start);
    return all.subspan(offset, std::min(bytes, all.size() - offset));
  }

  void read_window(std::int64_t position, std::size_t bytes) {
    constexpr std::size_t kWindow = 256 * 1024;
    const auto there = static_cast<std::size_t>(std::max<std::int64_t>(0, size() - position));
    window.resize(std::min(std::max(bytes, kWindow), there));
    window_start = position;
    std::size_t read = 0;
    while (read < window.size()) {
      const ssize_t got = ::pread(descriptor, window.data() + read, window.size() - read,
                                  position + static_cast<std::int64_t>(read));
      if (got <= 0) break;
      read += static_cast<std::size_t>(got);
    }
    window.resize(read);
  }

  void forget_window() { window.clear(); }

  /// What is there of an event whose header can be one; nothing of anything else.
  std::optional<EventHeader> header_at(std::int64_t position) {
    const auto bytes = at(position, kEventHeaderBytes);
    return bytes.size() < kEventHeaderBytes ? std::nullopt : event_header(bytes);
  }

  /// Whether an event ends there: another one follows, or the file ends, be it in the middle of the
  /// next one's sync word.
  bool ends_well_at(std::int64_t position) {
    const auto bytes = at(position, kSyncWordBytes);
    return bytes.size() < kSyncWordBytes || starts_with_sync_word(bytes);
  }

  bool holds(std::int64_t position, const EventHeader& header) const {
    return static_cast<std::int64_t>(header.event_bytes()) <= size() - position;
  }

  /// Where, between two positions, the first event starts that is whole and ends well.
  std::optional<std::int64_t> whole_event_within(std::int64_t from, std::int64_t to) {
    constexpr std::size_t kStep = 64 * 1024;
    while (from < to) {
      const auto bytes = at(from, kStep + kSyncWordBytes - 1);
      if (bytes.size() < kSyncWordBytes) return std::nullopt;
      const std::size_t starts = bytes.size() - kSyncWordBytes + 1;
      // A copy of where they are: the window moves when one of them is looked at.
      std::vector<std::int64_t> candidates;
      for (std::size_t i = 0; i < starts; ++i) {
        if (bytes[i] == kSyncWord >> 24 && starts_with_sync_word(bytes.subspan(i))) {
          candidates.push_back(from + static_cast<std::int64_t>(i));
        }
      }
      for (const std::int64_t candidate : candidates) {
        if (candidate >= to) return std::nullopt;
        const auto header = header_at(candidate);
        if (header && holds(candidate, *header) &&
            ends_well_at(candidate + static_cast<std::int64_t>(header->event_bytes()))) {
          return candidate;
        }
      }
      from += static_cast<std::int64_t>(starts);
    }
    return std::nullopt;
  }

  /// Where the next whole event starts; nothing while none is there.
  std::optional<std::int64_t> next_event() {
    const std::int64_t here = end_of_last;
    const auto header = header_at(here);
    // One that is not whole is being written, unless others follow where it says that it still is.
    std::int64_t unclear_to = size();
    if (header && holds(here, *header)) {
      unclear_to = here + static_cast<std::int64_t>(header->event_bytes());
      if (ends_well_at(unclear_to)) return here;
    }
    const std::int64_t first = here + (header ? std::int64_t{kSyncWordBytes} : 0);
    if (const auto found = whole_event_within(first, unclear_to)) return found;
    // Its lengths are right as far as anybody can tell; what follows it is damaged.
    if (header && holds(here, *header)) return here;
    return std::nullopt;
  }

  void note_damage(std::int64_t end) {
    if (end == end_of_last || (!damaged.empty() && damaged.back().position >= end_of_last)) return;
    damaged.push_back({end_of_last, end - end_of_last});
  }

  std::filesystem::path path;
  int descriptor;
  std::int64_t end_of_last = 0;  // where the last whole message ends
  std::vector<DamagedBytes> damaged;
  std::vector<std::uint8_t> window;
  std::int64_t window_start = 0;
};

LogReader::LogReader(const std::filesystem::path& file, const std::optional<RunKey>& key)
    : key_(key) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw LogError(file.string() + ": no such file");
  }
  file_ = std::make_unique<File>(file);
}
LogReader::~LogReader() = default;
LogReader::LogReader(LogReader&&) noexcept = default;
LogReader& LogReader::operator=(LogReader&&) noexcept = default;

const std::filesystem::path& LogReader::file() const { return file_->path; }

std::optional<LoggedMessage> LogReader::next() {
  const auto start = file_->next_event();
  if (!start) {
    // What is only half there may be something else by the next time.
    file_->forget_window();
    return std::nullopt;
  }
  file_->note_damage(*start);
  const EventHeader header = *file_->header_at(*start);
  const auto bytes = file_->at(*start, header.event_bytes()).subspan(kEventHeaderBytes);
  const auto channel = bytes.first(header.channel_bytes);
  const auto data = bytes.subspan(header.channel_bytes);
  file_->end_of_last = *start + static_cast<std::int64_t>(header.event_bytes());
  LoggedMessage message{std::string(channel.begin(), channel.end()),
                        {data.begin(), data.end()},
                        header.number,
                        header.received_us};
  message.signature = signature_of(message.channel, message.bytes, key_);
  return message;
}

std::int64_t LogReader::position() const { return file_->end_of_last; }
void LogReader::seek(std::int64_t position) { file_->end_of_last = position; }

const std::vector<DamagedBytes>& LogReader::damaged() const { return file_->damaged; }

std::int64_t LogReader::bytes_left() const { return file_->size() - file_->end_of_last; }

void LogReader::cut_rest() {
  if (bytes_left() <= 0) return;
  std::error_code error;
  std::filesystem::resize_file(file_->path, static_cast<std::uintmax_t>(file_->end_of_last), error);
  if (error) throw LogError(file_->path.string() + ": " + error.message());
  file_->forget_window();
}

}  // namespace nextview
