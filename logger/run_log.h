#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lcmtypes/channels.h"
#include "logger/log_contents.h"
#include "logger/log_reader.h"
#include "logger/run_record.h"

namespace nextview {

/// What was found in a log.
struct LogCounters {
  std::int64_t messages = 0;       ///< in all
  std::int64_t ours = 0;           ///< of the run
  std::int64_t foreign = 0;        ///< of other runs, or on channels that are not ours
  std::int64_t of_other_runs = 0;  ///< of the foreign ones, on channels that are ours
  std::int64_t repeated = 0;       ///< the same again, which is how lost messages are made good
  std::int64_t signatures_unchecked = 0;  ///< messages with one, without a key
};

/// Reads the messages of one run out of its log, through the same decode-and-validate path as the
/// processes on the bus.
class RunLog {
 public:
  /// @param run only messages of this run are taken; nothing: of the first one with a configuration
  /// @param key without whose signature no message is taken; nothing: signatures are not checked
  /// @throws LogError when the file cannot be opened
  RunLog(const std::filesystem::path& file, std::optional<std::int64_t> run,
         RangeImages range_images, const std::optional<RunKey>& key = std::nullopt);
  /// @param files of a log that was split or rotated, in the order in which they were recorded
  RunLog(const std::vector<std::filesystem::path>& files, std::optional<std::int64_t> run,
         RangeImages range_images, const std::optional<RunKey>& key = std::nullopt);

  /// The file, or the last of several.
  const std::filesystem::path& file() const { return readers_.back().file(); }
  const std::optional<RunKey>& key() const { return readers_.back().key(); }

  /// Takes in what has been written since the last call.
  void read_on();

  /// Of views that are whole: what they tried is freed, and so is what tells whether a range image
  /// that comes again is the same. Only while the run goes on; a replay looks at everything.
  void settle(int views);
  /// Where the first message of a view that is not settled begins.
  std::int64_t begin_of_view(int view) const;
  /// Where the last message read ends.
  std::int64_t position() const { return readers_[reading_].position(); }

  const RunRecord& record() const { return record_; }
  RunRecord& record() { return record_; }
  const LogCounters& counters() const { return counters_; }
  /// What the log holds as a file.
  const LogContents& contents() const { return contents_; }
  /// The other runs whose configurations are in the log.
  const std::vector<std::int64_t>& other_runs() const { return other_runs_; }
  /// Messages that cannot be right and were left out, as everybody on the bus does, one line each.
  const std::vector<std::string>& dropped() const { return dropped_; }
  /// Messages that are there twice but differ, one line each.
  const std::vector<std::string>& contradictions() const { return contradictions_; }
  /// Ends of the run after the first one, which counts, one line each.
  const std::vector<std::string>& later_ends() const { return later_ends_; }
  /// Bytes at the end that are no whole message.
  std::int64_t bytes_left() const { return readers_.back().bytes_left(); }
  /// Cuts them off; see LogReader.
  void cut_rest() { readers_.back().cut_rest(); }

 private:
  /// 128-bit hash of a message's bytes.
  using Hash = std::pair<std::uint64_t, std::uint64_t>;

  std::optional<LoggedMessage> next();
  void note_damage();
  void take(const LoggedMessage& message);
  template <class Message>
  void take_as(const LoggedMessage& message);

  void note_begin(int view);

  std::vector<LogReader> readers_;  // one a file
  std::size_t reading_ = 0;         // of them
  std::size_t damage_noted_ = 0;    // of the one that is being read
  LogContents contents_;
  std::optional<std::int64_t> run_;
  RunRecord record_;
  LogCounters counters_;
  std::vector<std::int64_t> other_runs_;
  std::vector<std::string> dropped_;
  std::vector<std::string> contradictions_;
  std::vector<std::string> later_ends_;
  std::map<std::pair<std::string, MessageKey>, Hash> seen_;
  std::map<int, std::int64_t> begin_of_view_;  // of those that are not settled
  std::int64_t begin_ = 0;                     // of the message under way
  int settled_views_ = 0;
  std::vector<LoggedMessage> before_config_;  // while the run is not known
};

}  // namespace nextview
