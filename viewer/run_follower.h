#pragma once

#include <map>
#include <memory>
#include <optional>

#include "lcmtypes/channels.h"
#include "mapper/map_blocks.h"
#include "mapper/map_builder.h"
#include "sensor/range_image_message.h"
#include "viewer/viewed_run.h"

namespace nextview {

/// Takes the messages of one run, from the bus or out of a log, folds its range images as the
/// mapper does, and hands on every view once its range image, commit, goal and arrival are there.
/// Keeps nothing of the views before.
class RunFollower {
 public:
  explicit RunFollower(ViewedRun& viewed) : viewed_(viewed) {}

  /// The first message, and each only once.
  void add(const run_config_t& config);
  void add(const goal_t& goal);
  void add(const search_t& search);
  void add(const arrival_t& arrival);
  void add(const range_image_t& part);
  void add(const commit_t& commit);
  void add(const stop_t& stop);

  bool has_config() const { return config_.has_value(); }
  /// The view whose messages are collected at present.
  int next_view() const { return next_view_; }
  /// Whether something of a later view, or the end, has come, so that something of the present one
  /// must have been lost.
  bool waits() const;
  /// The end of the run and all views before it are there.
  bool ended() const;

  /// What of the present view is missing, by attempt 0: all there are.
  bool lacks_goal() const;
  bool lacks_arrival() const;
  bool lacks_image() const { return !images_.contains(next_view_); }
  bool lacks_commit() const { return !commits_.contains(next_view_); }

 private:
  template <class Message>
  bool lacks_attempt(const std::map<MessageKey, Message>& messages) const;
  void note_view(int view);
  void advance();
  void fold(const ReceivedRangeImage& received, const commit_t& commit);
  nlohmann::json row_of(const commit_t& commit, const FoldReport& report, bool same_digest) const;

  ViewedRun& viewed_;
  std::optional<run_config_t> config_;
  std::unique_ptr<MapBuilder> builder_;
  std::unique_ptr<MapBlocks> blocks_;
  RangeImageAssembler assembler_;
  // Of the present view and later ones.
  std::map<int, ReceivedRangeImage> images_;
  std::map<int, commit_t> commits_;
  std::map<MessageKey, goal_t> goals_;
  std::map<MessageKey, arrival_t> arrivals_;
  std::optional<stop_t> stop_;
  int next_view_ = 1;
  int latest_view_ = 0;
  double path_m_ = 0.0;
};

}  // namespace nextview
