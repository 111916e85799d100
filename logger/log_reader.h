#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "logger/signature.h"

namespace nextview {

/// A log that cannot be read; the message names the file.
class LogError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A message as it was logged.
struct LoggedMessage {
  std::string channel;  ///< any bytes, and none at all where somebody has sent such a thing
  std::vector<std::uint8_t> bytes;
  std::uint64_t number = 0;      ///< of the event, by whoever has recorded it
  std::int64_t received_us = 0;  ///< by the recorder's clock; nothing of a run depends on it
  Signature signature = Signature::None;

  /// Whether it is taken: with a key only what bears its signature.
  bool is_authentic() const { return signature != Signature::Wrong; }
  /// What was published, without its signature.
  std::span<const std::uint8_t> message() const {
    const bool is_signed = signature == Signature::Unchecked || signature == Signature::Right;
    return std::span(bytes).first(bytes.size() - (is_signed ? RunKey::kSignatureBytes : 0));
  }
};

/// Bytes of a log in which no whole event stands.
struct DamagedBytes {
  std::int64_t position = 0;
  std::int64_t bytes = 0;
};

/// Reads an LCM log message by message, also while the recorder is still writing it. Reads on past
/// what is damaged: at the next event that is whole, found by LCM's sync word. Whatever a length
/// says, no more is allocated than there is.
class LogReader {
 public:
  /// @param key of the run, by which messages must be signed to be authentic; nothing: signatures
  ///        are not checked
  /// @throws LogError when there is no such file or it cannot be opened
  explicit LogReader(const std::filesystem::path& file,
                     const std::optional<RunKey>& key = std::nullopt);
  ~LogReader();
  LogReader(LogReader&&) noexcept;
  LogReader& operator=(LogReader&&) noexcept;

  const std::filesystem::path& file() const;
  const std::optional<RunKey>& key() const { return key_; }

  /// The next message; nothing at the end, where it may be called again when the file has grown.
  std::optional<LoggedMessage> next();

  /// Where the last message read ends, and the next one is looked for.
  std::int64_t position() const;
  /// Goes there, to where a message ends.
  void seek(std::int64_t position);

  /// What next() has gone past, in order.
  const std::vector<DamagedBytes>& damaged() const;

  /// Bytes behind the last message read: a message being written, a log that was cut off, or
  /// something that is no log.
  std::int64_t bytes_left() const;
  /// Cuts them off, so that a recorder can go on behind the last whole message. Nobody may be
  /// writing.
  /// @throws LogError when the file cannot be changed
  void cut_rest();

 private:
  struct File;
  std::unique_ptr<File> file_;
  std::optional<RunKey> key_;
};

}  // namespace nextview
