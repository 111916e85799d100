#include "logger/run_record.h"

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <utility>

#include "lcmtypes/run_course.h"
#include "planner/termination.h"

namespace nextview {
namespace {

template <class Map, class Key>
const typename Map::mapped_type* find_in(const Map& map, const Key& key) {
  const auto found = map.find(key);
  return found == map.end() ? nullptr : &found->second;
}

template <class Message>
MissingMessage missing_message(int view, int attempt) {
  return {Channel<Message>::name, view, attempt};
}
template <class Message>
MissingMessage message_of(const MessageKey& key) {
  return missing_message<Message>(key.view, key.attempt);
}

}  // namespace

std::string describe(const MissingMessage& missing) {
  std::string text(missing.channel);
  if (missing.view > 0) text += " of view " + std::to_string(missing.view);
  if (missing.attempt > 0) text += ", attempt " + std::to_string(missing.attempt);
  return text;
}

void RunRecord::check_fits(int view, int attempt) const {
  if (!config_) throw RejectedMessage("it came before the run's configuration");
  check_fits_run(*config_, view, attempt);
}

void RunRecord::add(const goal_t& goal) {
  check_fits(goal.view, goal.attempt);
  goals_.emplace(key_of(goal), goal);
}

void RunRecord::add(const search_t& search) {
  check_fits(search.view, search.attempt);
  searches_.emplace(key_of(search), search);
}

void RunRecord::add(const arrival_t& arrival) {
  check_fits(arrival.view, arrival.attempt);
  arrivals_.emplace(key_of(arrival), arrival);
}

void RunRecord::add(const commit_t& commit) {
  check_fits(commit.view, commit.attempt);
  commits_.emplace(commit.view, commit);
}

void RunRecord::add(const stop_t& stop) {
  check_fits(stop.views, stop.final_attempt);
  if (!stop_) stop_ = stop;
}

void RunRecord::add(const range_image_t& part) {
  check_fits(part.view, part.attempt);
  check_raster(part, *config_);
  const MessageKey key{part.view, part.attempt, 0};
  if (whole_images_.contains(key)) return;
  auto image = assembler_.add(part);
  if (!image) return;
  whole_images_.insert(key);
  if (range_images_ == RangeImages::Keep) {
    images_.emplace(key, std::move(*image));
  }
}

void RunRecord::add(const timing_t& timing) {
  // Those of the last view come with the one after it.
  check_fits(timing.view - 1, timing.attempt);
  roles_.insert(timing.role);
  const std::vector<std::string_view> names = names_of(timing.duration_names);
  for (std::size_t i = 0; i < names.size(); ++i) {
    durations_s_.emplace(std::tuple(timing.view, timing.attempt, std::string(names[i])),
                         timing.duration_s[i]);
  }
}

std::optional<double> RunRecord::duration_s(int view, int attempt, const std::string& name) const {
  const double* found = find_in(durations_s_, std::tuple(view, attempt, name));
  return found == nullptr ? std::nullopt : std::optional(*found);
}

const goal_t* RunRecord::goal(int view, int attempt) const {
  return find_in(goals_, MessageKey{view, attempt, 0});
}
const search_t* RunRecord::search(int view, int attempt) const {
  return find_in(searches_, MessageKey{view, attempt, 0});
}
const arrival_t* RunRecord::arrival(int view, int attempt) const {
  return find_in(arrivals_, MessageKey{view, attempt, 0});
}
const commit_t* RunRecord::commit(int view) const { return find_in(commits_, view); }
const ReceivedRangeImage* RunRecord::range_image(int view, int attempt) const {
  return find_in(images_, MessageKey{view, attempt, 0});
}

void RunRecord::forget_range_image(int view, int attempt) { images_.erase({view, attempt, 0}); }

int RunRecord::latest_view() const {
  int latest = committed_views();
  for (const auto* by_key : {&whole_images_}) {
    if (!by_key->empty()) latest = std::max(latest, by_key->rbegin()->view);
  }
  if (!goals_.empty()) latest = std::max(latest, goals_.rbegin()->first.view);
  if (!arrivals_.empty()) latest = std::max(latest, arrivals_.rbegin()->first.view);
  return latest;
}

bool RunRecord::ends_without_goal() const {
  return stop_ && stop_->stop_reason == to_string(StopReason::NoFeasibleGoal);
}

bool RunRecord::ends_early() const {
  if (!stop_) return true;
  constexpr std::array kByTheRun = {StopReason::BusFailed, StopReason::NoAnswer,
                                    StopReason::ProcessDied, StopReason::Interrupted};
  return std::any_of(kByTheRun.begin(), kByTheRun.end(),
                     [this](StopReason reason) { return to_string(reason) == stop_->stop_reason; });
}

bool RunRecord::ends_by_search() const {
  return stop_ && stop_->views < config_->planner.max_views &&
         (stop_->stop_reason == to_string(StopReason::NothingLeft) || ends_without_goal());
}

void RunRecord::add_missing_attempt(int view, int attempt,
                                    std::vector<MissingMessage>& missing) const {
  const bool has_search = view > 1;  // view 1 is the scan at the start, nothing was searched for
  if (!goal(view, attempt)) missing.push_back(missing_message<goal_t>(view, attempt));
  if (has_search && !search(view, attempt)) {
    missing.push_back(missing_message<search_t>(view, attempt));
  }
  if (!arrival(view, attempt)) missing.push_back(missing_message<arrival_t>(view, attempt));
}

std::vector<MissingMessage> RunRecord::missing_of_view(int view) const {
  const commit_t* committed = commit(view);
  // Only the commit says which attempt was the last.
  if (!committed) return {missing_message<commit_t>(view, 0)};
  std::vector<MissingMessage> missing;
  for (int attempt = 1; attempt <= committed->attempt; ++attempt) {
    add_missing_attempt(view, attempt, missing);
  }
  if (!whole_images_.contains({view, committed->attempt, 0})) {
    missing.push_back(missing_message<range_image_t>(view, committed->attempt));
  }
  return missing;
}

std::vector<MissingMessage> RunRecord::missing() const {
  std::vector<MissingMessage> missing;
  if (!config_) missing.push_back(missing_message<run_config_t>(0, 0));
  if (!stop_) missing.push_back(missing_message<stop_t>(0, 0));
  const int views = stop_ ? std::max(stop_->views, views_taken()) : latest_view();
  for (int view = whole_views() + 1; view <= views; ++view) {
    const auto of_view = missing_of_view(view);
    missing.insert(missing.end(), of_view.begin(), of_view.end());
  }
  if (ends_without_goal()) {
    // The last attempt has a goal only if one was found and then refused.
    const int view = stop_->views + 1;
    for (int attempt = 1; attempt <= stop_->final_attempt; ++attempt) {
      if (attempt == stop_->final_attempt && !goal(view, attempt)) continue;
      add_missing_attempt(view, attempt, missing);
    }
  }
  return missing;
}

int RunRecord::whole_views() const {
  while (commit(whole_views_ + 1) && missing_of_view(whole_views_ + 1).empty()) ++whole_views_;
  return whole_views_;
}

void RunRecord::forget_searches(int view) {
  for (auto search = searches_.lower_bound({searches_forgotten_until_ + 1, 0, 0});
       search != searches_.end() && search->first.view <= view; ++search) {
    search->second = {};
  }
  searches_forgotten_until_ = std::max(searches_forgotten_until_, view);
}

int RunRecord::committed_views() const { return commits_.empty() ? 0 : commits_.rbegin()->first; }

int RunRecord::views_taken() const { return std::max(committed_views(), latest_view() - 1); }

int RunRecord::final_attempt(int view) const {
  if (const commit_t* committed = commit(view)) return committed->attempt;
  const auto latest_in = [view](const auto& by_key, const auto& key_of_entry) {
    const auto after = by_key.lower_bound({view + 1, 0, 0});
    if (after == by_key.begin()) return 0;
    const MessageKey key = key_of_entry(*std::prev(after));
    return key.view == view ? key.attempt : 0;
  };
  const auto first = [](const auto& entry) { return entry.first; };
  if (const int attempt = latest_in(whole_images_, std::identity{}); attempt > 0) return attempt;
  return std::max(latest_in(goals_, first), latest_in(arrivals_, first));
}

std::vector<MissingMessage> RunRecord::held() const {
  std::vector<MissingMessage> held;
  for (const auto& [key, goal] : goals_) held.push_back(message_of<goal_t>(key));
  for (const auto& [key, search] : searches_) held.push_back(message_of<search_t>(key));
  for (const auto& [key, arrival] : arrivals_) held.push_back(message_of<arrival_t>(key));
  for (const MessageKey& key : whole_images_) held.push_back(message_of<range_image_t>(key));
  for (const auto& [view, commit] : commits_) held.push_back(message_of<commit_t>({view, 0, 0}));
  return held;
}

std::vector<MissingMessage> RunRecord::held_in_part() const {
  std::vector<MissingMessage> held;
  for (const MessageKey& key : assembler_.incomplete()) {
    held.push_back(message_of<range_image_t>(key));
  }
  return held;
}

}  // namespace nextview
