#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace nextview {

/// A log that cannot be read; the message names the file.
class LogError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A message as it was logged. The time it was received at is left out: nothing depends on it.
struct LoggedMessage {
  std::string channel;
  std::vector<std::uint8_t> bytes;
};

/// Reads an LCM log message by message, also while the recorder is still writing it.
class LogReader {
 public:
  /// @throws LogError when there is no such file or it cannot be opened
  explicit LogReader(const std::filesystem::path& file);
  ~LogReader();
  LogReader(LogReader&&) noexcept;
  LogReader& operator=(LogReader&&) noexcept;

  /// The next message; nothing at the end, where it may be called again when the file has grown.
  std::optional<LoggedMessage> next();

  /// Where the last message read ends, and the next one is looked for.
  std::int64_t position() const;
  /// Goes there, to where a message ends.
  void seek(std::int64_t position);

  /// Bytes behind the last message read: a message being written, a log that was cut off, or
  /// something that is no log.
  std::int64_t bytes_left() const;
  /// Cuts them off, so that a recorder can go on behind the last whole message. Nobody may be
  /// writing.
  /// @throws LogError when the file cannot be changed
  void cut_rest();

 private:
  struct File;  // hides LCM's headers
  std::unique_ptr<File> file_;
};

}  // namespace nextview
