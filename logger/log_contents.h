#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lcmtypes/channels.h"
#include "logger/log_reader.h"

namespace nextview {

/// What is wrong with a log as a file, whatever its messages say; one line each.
struct LogFaults {
  std::vector<std::string> differences;  ///< it is not what was recorded
  std::vector<std::string> missing;      ///< something of it is not there
  std::vector<std::string> remarks;      ///< no fault of the run's, but to be said
  bool sealed = false;                   ///< a seal is there
};

/// What a log holds, event by event: how many on each channel, in what order they are numbered,
/// what is damaged, and whether it is still what it was when it was sealed (seal_t).
class LogContents {
 public:
  void add(const LoggedMessage& event);
  /// Bytes that are no event.
  void add_damage(const std::string& file, const DamagedBytes& damaged);

  std::size_t events() const { return numbers_.size(); }
  /// Of the last event; 0 where there is none.
  std::int64_t last_received_us() const { return times_us_.empty() ? 0 : times_us_.back(); }
  /// Events by channel, be they whose they may.
  const std::map<std::string, std::int64_t>& events_on() const { return events_on_; }

  /// The seal of what has been added.
  seal_t seal(std::int64_t run, std::int64_t utime) const;
  bool is_sealed(std::int64_t run) const;

  /// @param run whose seal counts
  /// @param end_utime of the run's end, which the seal says too; nothing: the log has no end
  LogFaults faults(std::int64_t run, std::optional<std::int64_t> end_utime = std::nullopt) const;

 private:
  /// 128-bit hash of a message's bytes.
  using Hash = std::pair<std::uint64_t, std::uint64_t>;
  struct Tally {
    std::int64_t distinct = 0;
    std::string digest;
  };
  struct LoggedSeal {
    std::size_t events_before = 0;
    std::vector<std::uint8_t> bytes;
  };

  Tally tally_of(const std::string& channel) const;
  std::string times_digest(std::size_t events) const;
  void check_numbers(LogFaults& faults) const;
  void check_seals(std::int64_t run, std::optional<std::int64_t> end_utime,
                   LogFaults& faults) const;
  void check_channels(LogFaults& faults) const;
  void check_seal(const seal_t& seal, std::size_t events_before, LogFaults& faults) const;

  std::map<std::string, std::int64_t> events_on_;
  std::map<std::string, std::vector<Hash>> messages_;  // by channel, of those named as ours
  std::vector<std::uint64_t> numbers_;
  std::vector<std::int64_t> times_us_;
  std::vector<LoggedSeal> seals_;
  std::vector<std::string> damage_;
  std::int64_t odd_self_tests_ = 0;
};

}  // namespace nextview
