#include "viewer/run_follower.h"

#include <cmath>

#include "mapper/mapper_config.h"
#include "viewer/scan_bytes.h"
#include "viewer/surface_blocks.h"

namespace nextview {
namespace {

using Json = nlohmann::json;

Json vector_json(const double* vector) { return {vector[0], vector[1], vector[2]}; }

Json next_json(const goal_t& goal) {
  Json waypoints = Json::array();
  for (const auto& waypoint : goal.waypoint_m) waypoints.push_back(vector_json(waypoint.data()));
  return {{"view", goal.view},
          {"attempt", goal.attempt},
          {"position_m", vector_json(goal.position_m)},
          {"pan_rad", goal.pan_rad},
          {"tilt_rad", goal.tilt_rad},
          {"fitness", goal.fitness},
          {"expected_gain_m2", goal.expected_gain_m2},
          {"waypoints", waypoints},
          {"reason", goal.reason}};
}

/// Per position f32 x, y, z, metres, and its fitness.
std::vector<std::uint8_t> tried_bytes(const search_t& search) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < search.tried_position_m.size(); ++i) {
    for (const double value : search.tried_position_m[i]) {
      append_number(bytes, static_cast<float>(value));
    }
    append_number(bytes, static_cast<float>(search.tried_fitness[i]));
  }
  return bytes;
}

}  // namespace

void RunFollower::add(const run_config_t& config) {
  config_ = config;
  builder_ = std::make_unique<MapBuilder>(grid_of(config), window_of(config));
  blocks_ = std::make_unique<MapBlocks>(builder_->map());
  viewed_.set_config(config);
}

template <class Message>
bool RunFollower::lacks_attempt(const std::map<MessageKey, Message>& messages) const {
  const auto commit = commits_.find(next_view_);
  return commit == commits_.end() || !messages.contains({next_view_, commit->second.attempt, 0});
}

void RunFollower::note_view(int view) { latest_view_ = std::max(latest_view_, view); }

void RunFollower::add(const goal_t& goal) {
  check_fits_run(*config_, goal.view, goal.attempt);
  note_view(goal.view);
  viewed_.set_next(goal.view - 1, next_json(goal));
  if (goal.view >= next_view_) goals_.emplace(key_of(goal), goal);
  advance();
}

void RunFollower::add(const search_t& search) {
  check_fits_run(*config_, search.view, search.attempt);
  viewed_.set_search(search.view - 1, tried_bytes(search));
}

void RunFollower::add(const arrival_t& arrival) {
  check_fits_run(*config_, arrival.view, arrival.attempt);
  note_view(arrival.view);
  if (arrival.view >= next_view_) arrivals_.emplace(key_of(arrival), arrival);
  advance();
}

void RunFollower::add(const range_image_t& part) {
  check_fits_run(part, *config_);
  note_view(part.view);
  if (part.view < next_view_) return;
  if (auto image = assembler_.add(part)) images_.emplace(part.view, std::move(*image));
  advance();
}

void RunFollower::add(const commit_t& commit) {
  check_fits_run(*config_, commit.view, commit.attempt);
  note_view(commit.view);
  if (commit.view >= next_view_) commits_.emplace(commit.view, commit);
  advance();
}

void RunFollower::add(const stop_t& stop) {
  if (!stop_) stop_ = stop;
  advance();
}

bool RunFollower::waits() const {
  return latest_view_ > next_view_ || commits_.contains(next_view_) ||
         (stop_ && stop_->views >= next_view_);
}

bool RunFollower::ended() const { return stop_ && stop_->views < next_view_; }

bool RunFollower::lacks_goal() const { return lacks_attempt(goals_); }
bool RunFollower::lacks_arrival() const { return lacks_attempt(arrivals_); }

void RunFollower::advance() {
  for (;;) {
    const auto image = images_.find(next_view_);
    const auto commit = commits_.find(next_view_);
    if (image == images_.end() || commit == commits_.end()) break;
    if (lacks_goal() || lacks_arrival()) break;
    fold(image->second, commit->second);
    images_.erase(image);
    commits_.erase(commit);
    ++next_view_;
    const MessageKey first_kept{next_view_, 0, 0};
    goals_.erase(goals_.begin(), goals_.lower_bound(first_kept));
    arrivals_.erase(arrivals_.begin(), arrivals_.lower_bound(first_kept));
  }
  if (ended()) viewed_.set_end(*stop_);
}

void RunFollower::fold(const ReceivedRangeImage& received, const commit_t& commit) {
  const FoldReport& report = builder_->fold(received.image);
  ViewedRun::View view;
  for (const std::uint32_t block : changed_blocks(*blocks_, report)) {
    const VoxelIndex at = blocks_->coordinate(block);
    view.blocks.push_back({block,
                           {static_cast<std::int16_t>(at[0]), static_cast<std::int16_t>(at[1]),
                            static_cast<std::int16_t>(at[2])},
                           surface_of_block(builder_->map(), *blocks_, block)});
  }
  path_m_ += arrivals_.at({commit.view, commit.attempt, 0}).path_length_m;
  view.row = row_of(commit, report, builder_->digest() == commit.map_digest);
  view.scan = scan_bytes(received.image);
  viewed_.add_view(view);
}

Json RunFollower::row_of(const commit_t& commit, const FoldReport& report, bool same_digest) const {
  const goal_t& goal = goals_.at({commit.view, commit.attempt, 0});
  Json refused = Json::array();
  for (const auto& [key, arrival] : arrivals_) {
    if (key.view == commit.view && arrival.arrived == 0) refused.push_back(arrival.refusal);
  }
  Json row = {{"view", commit.view},
              {"position_m", vector_json(commit.used_position_m)},
              {"pan_rad", commit.pan_rad},
              {"tilt_rad", commit.tilt_rad},
              {"simulated_s", static_cast<double>(commit.utime) * 1e-6},
              {"path_m", path_m_},
              {"occupied", commit.occupied_voxels},
              {"planes", commit.occlusion_plane_voxels},
              {"new_voxels", report.newly_occupied},
              {"area_m2", commit.occupied_area_m2},
              {"plane_area_m2", commit.occlusion_plane_area_m2},
              {"quality", commit.mean_quality},
              {"points", commit.points},
              {"digest", commit.map_digest},
              {"same_digest", same_digest},
              {"refused", refused}};
  if (commit.view > 1) {
    row["fitness"] = goal.fitness;
    row["tried"] = goal.evaluations;
    row["reason"] = goal.reason;
  }
  Json waypoints = Json::array();
  for (const auto& waypoint : goal.waypoint_m) waypoints.push_back(vector_json(waypoint.data()));
  row["waypoints"] = waypoints;
  return row;
}

}  // namespace nextview
