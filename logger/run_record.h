#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "lcmtypes/channels.h"
#include "sensor/range_image_message.h"

namespace nextview {

/// A message by its channel, and the key by which it is asked for.
struct MissingMessage {
  std::string_view channel;
  int view = 0;
  int attempt = 0;
  auto operator<=>(const MissingMessage&) const = default;
};

/// "NEXTVIEW_GOAL of view 3, attempt 1".
std::string describe(const MissingMessage& missing);

/// What is to be done with range images once they are whole.
enum class RangeImages { Keep, OnlyCount };

/// The messages of one run by their keys, whether they come from the bus or out of a log, and what
/// is missing among them. Each message is added once, the configuration first. Timings and statuses
/// are there or not: nothing misses them.
///
/// add() throws RejectedMessage for a view or attempt that the run cannot have, and for a part of a
/// range image that contradicts the parts before it.
class RunRecord {
 public:
  explicit RunRecord(RangeImages range_images) : range_images_(range_images) {}

  void add(const run_config_t& config) { config_ = config; }
  void add(const goal_t& goal);
  void add(const search_t& search);
  void add(const arrival_t& arrival);
  void add(const range_image_t& part);
  void add(const commit_t& commit);
  /// The first end counts: a run that has ended cannot end again.
  void add(const stop_t& stop);
  /// The run is taken up again: its end is none any more.
  void forget_stop() { stop_.reset(); }
  void add(const timing_t& timing);
  void add(const status_t& status) { roles_.insert(status.role); }

  const std::optional<run_config_t>& config() const { return config_; }
  const std::optional<stop_t>& stop() const { return stop_; }
  const goal_t* goal(int view, int attempt) const;
  const search_t* search(int view, int attempt) const;
  const arrival_t* arrival(int view, int attempt) const;
  const commit_t* commit(int view) const;
  /// nullptr until all parts are there, or when images are only counted.
  const ReceivedRangeImage* range_image(int view, int attempt) const;
  /// A duration somebody has measured (see timing_t); nothing when it was lost.
  std::optional<double> duration_s(int view, int attempt, const std::string& name) const;
  const std::map<MessageKey, arrival_t>& arrivals() const { return arrivals_; }
  const std::map<int, commit_t>& commits() const { return commits_; }
  /// Who has said how it is (status_t) or how long it took (timing_t), by role.
  const std::set<std::string>& roles() const { return roles_; }
  /// Frees a range image that is needed no more; it still counts as there.
  void forget_range_image(int view, int attempt);

  /// The latest view anything is known of; 0 before the first goal.
  int latest_view() const;
  /// Whether the planner has ended in the middle of a view's attempts; see stop_t::final_attempt.
  bool ends_without_goal() const;
  /// Whether the run was ended while the planner would have gone on: no end, or one of those that
  /// the run publishes itself.
  bool ends_early() const;
  /// Whether the planner has ended because a search of its, and not a count of views, says so.
  bool ends_by_search() const;

  /// What a committed view needs and is not there: its commit, else for each attempt its goal,
  /// search and arrival, and the range image.
  std::vector<MissingMessage> missing_of_view(int view) const;
  /// What a whole run needs and is not there, for every view taken, whatever its end says.
  /// Before the stop: what the views so far need.
  std::vector<MissingMessage> missing() const;
  /// The view up to which everything is here that a whole run needs.
  int whole_views() const;
  /// Frees what the searches up to this view tried; they still count as there.
  void forget_searches(int view);
  /// The last view that was committed, or 0.
  int committed_views() const;
  /// The last view that must have been taken: committed, or followed by something of a later one.
  int views_taken() const;
  /// The attempt at which a view was taken: its commit's, else its range image's, else the last one
  /// there is anything of; 0 when there is nothing.
  int final_attempt(int view) const;
  /// Every goal, search, arrival, whole range image and commit that is here.
  std::vector<MissingMessage> held() const;
  /// The parts of range images of which others are lacking.
  const RangeImageAssembler& range_image_parts() const { return assembler_; }
  /// Range images of which some parts are here, and some are not.
  std::vector<MissingMessage> held_in_part() const;

 private:
  void check_fits(int view, int attempt) const;
  void add_missing_attempt(int view, int attempt, std::vector<MissingMessage>& missing) const;

  RangeImages range_images_;
  std::optional<run_config_t> config_;
  std::optional<stop_t> stop_;
  std::map<MessageKey, goal_t> goals_;  // by view and attempt, as are the next two
  std::map<MessageKey, search_t> searches_;
  std::map<MessageKey, arrival_t> arrivals_;
  std::map<int, commit_t> commits_;
  RangeImageAssembler assembler_;
  std::map<std::tuple<int, int, std::string>, double> durations_s_;  // by view, attempt, name
  std::set<MessageKey> whole_images_;
  std::map<MessageKey, ReceivedRangeImage> images_;
  std::set<std::string> roles_;
  mutable int whole_views_ = 0;  // as last looked: what is whole remains so
  int searches_forgotten_until_ = 0;
};

}  // namespace nextview
