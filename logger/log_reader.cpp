#include "logger/log_reader.h"

#include <lcm/eventlog.h>
#include <sys/stat.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <utility>

namespace nextview {
namespace {

constexpr long kHeaderBytes = 28;  // of a message in a log

}  // namespace

struct LogReader::File {
  explicit File(const std::filesystem::path& file)
      : path(file), log(lcm_eventlog_create(file.c_str(), "r")) {
    if (log == nullptr) throw LogError(path.string() + ": cannot be opened");
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() { lcm_eventlog_destroy(log); }

  /// The size of the whole message that comes next when its channel has no name, at which LCM's own
  /// reader stops; lcm-logger writes down what anybody says. Else 0. Moves in the file.
  long nameless_bytes() const {
    std::array<unsigned char, kHeaderBytes> header{};
    if (std::fread(header.data(), header.size(), 1, log->f) != 1) return 0;
    const auto number_at = [&header](std::size_t at) {
      return std::uint32_t{header[at]} << 24 | std::uint32_t{header[at + 1]} << 16 |
             std::uint32_t{header[at + 2]} << 8 | std::uint32_t{header[at + 3]};
    };
    constexpr std::uint32_t kSyncWord = 0xEDA1DA01;
    constexpr std::uint32_t kLargestDatagram = 1 << 16;
    const std::uint32_t data_bytes = number_at(24);
    if (number_at(0) != kSyncWord || number_at(20) != 0 || data_bytes > kLargestDatagram) return 0;
    const long size = kHeaderBytes + static_cast<long>(data_bytes);
    struct stat status {};
    const bool whole =
        ::fstat(::fileno(log->f), &status) == 0 && status.st_size - end_of_last >= size;
    return whole ? size : 0;
  }

  std::filesystem::path path;
  lcm_eventlog_t* log;
  long end_of_last = 0;  // where the last whole message ends
};

LogReader::LogReader(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw LogError(file.string() + ": no such file");
  }
  file_ = std::make_unique<File>(file);
}
LogReader::~LogReader() = default;
LogReader::LogReader(LogReader&&) noexcept = default;
LogReader& LogReader::operator=(LogReader&&) noexcept = default;

std::optional<LoggedMessage> LogReader::next() {
  // A message only half written is read again from its beginning when the file has grown.
  std::clearerr(file_->log->f);
  if (std::fseek(file_->log->f, file_->end_of_last, SEEK_SET) != 0) return std::nullopt;
  if (const long size = file_->nameless_bytes(); size > 0) {
    file_->end_of_last += size;
    return LoggedMessage{};
  }
  if (std::fseek(file_->log->f, file_->end_of_last, SEEK_SET) != 0) return std::nullopt;
  lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(file_->log);
  if (event == nullptr) return std::nullopt;
  // LCM looks at the sync word of the next message, and forgets to go back when it is half written.
  constexpr long kSyncWordBytes = 4;
  const long end = file_->end_of_last + kHeaderBytes + event->channellen + event->datalen;
  const long position = std::ftell(file_->log->f);
  file_->end_of_last = position - end < kSyncWordBytes ? end : position;
  LoggedMessage message;
  message.channel = event->channel;
  const auto* bytes = static_cast<const std::uint8_t*>(event->data);
  message.bytes.assign(bytes, bytes + event->datalen);
  lcm_eventlog_free_event(event);
  return message;
}

std::int64_t LogReader::position() const { return file_->end_of_last; }
void LogReader::seek(std::int64_t position) { file_->end_of_last = position; }

std::int64_t LogReader::bytes_left() const {
  struct stat status {};
  if (::fstat(::fileno(file_->log->f), &status) != 0) return 0;
  return status.st_size - file_->end_of_last;
}

void LogReader::cut_rest() {
  if (bytes_left() <= 0) return;
  std::error_code error;
  std::filesystem::resize_file(file_->path, static_cast<std::uintmax_t>(file_->end_of_last), error);
  if (error) throw LogError(file_->path.string() + ": " + error.message());
  // Opened anew, because what has been read of the rest stays in the stream's buffer.
  auto anew = std::make_unique<File>(file_->path);
  anew->end_of_last = file_->end_of_last;
  file_ = std::move(anew);
}

}  // namespace nextview
