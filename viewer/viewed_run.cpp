#include "viewer/viewed_run.h"

#include <algorithm>

#include "viewer/surface_blocks.h"

namespace nextview {
namespace {

using Json = nlohmann::json;

Json json_of_vector(const double (&vector)[3]) { return {vector[0], vector[1], vector[2]}; }

Json json_of(const run_config_t& config) {
  const map_config_t& map = config.map;
  Json first_m = Json::array();
  for (int axis = 0; axis < 3; ++axis) {
    first_m.push_back(map.map_origin_m[axis] + map.voxel_size_m * map.window_min[axis]);
  }
  return {{"run", std::to_string(config.run)},
          {"seed", config.seed},
          {"scene", config.scene_name},
          {"strategy", config.strategy},
          {"has_scene", config.has_scene != 0},
          {"max_views", config.planner.max_views},
          {"voxel_size_m", map.voxel_size_m},
          {"origin_m", json_of_vector(map.map_origin_m)},
          {"window_first_m", first_m},
          {"window_size", {map.window_size[0], map.window_size[1], map.window_size[2]}},
          {"start_m", json_of_vector(config.base.start_m)},
          {"range_max_m", config.sensor.range_max_m},
          {"version", config.program_version}};
}

/// What is said by others need not be UTF-8.
std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

}  // namespace

void ViewedRun::set_config(const run_config_t& config) {
  {
    const std::lock_guard lock(mutex_);
    config_ = config;
    note_.clear();
    ++facts_version_;
  }
  tell();
}

void ViewedRun::add_view(const View& view) {
  {
    const std::lock_guard lock(mutex_);
    const int number = static_cast<int>(views_.size()) + 1;
    for (const BlockSurface& block : view.blocks) {
      history_.add(number, block.number, block.coordinate, block.surface);
    }
    views_.push_back({text_of(view.row), file_.append(view.scan)});
  }
  tell();
}

ViewedRun::AfterView& ViewedRun::after_at(int view) {
  const auto place = static_cast<std::size_t>(view);
  if (after_.size() <= place) after_.resize(place + 1);
  ++after_[place].version;
  return after_[place];
}

void ViewedRun::set_search(int after_view, std::vector<std::uint8_t> tried) {
  {
    const std::lock_guard lock(mutex_);
    after_at(after_view).tried = file_.append(tried);
  }
  tell();
}

void ViewedRun::set_next(int after_view, const Json& next) {
  {
    const std::lock_guard lock(mutex_);
    after_at(after_view).next = file_.append(bytes_of(text_of(next)));
  }
  tell();
}

void ViewedRun::set_end(const stop_t& stop) {
  {
    const std::lock_guard lock(mutex_);
    stop_ = stop;
    pausable_ = false;
    pace_ = kAnyView;
    ++facts_version_;
  }
  tell();
}

void ViewedRun::set_note(const std::string& note) {
  {
    const std::lock_guard lock(mutex_);
    if (note_ == note) return;
    note_ = note;
    ++facts_version_;
  }
  tell();
}

void ViewedRun::set_pausable() {
  {
    const std::lock_guard lock(mutex_);
    pausable_ = true;
    ++facts_version_;
  }
  tell();
}

int ViewedRun::pace() const {
  const std::lock_guard lock(mutex_);
  return pace_;
}

void ViewedRun::set_pace(int last_view) {
  {
    const std::lock_guard lock(mutex_);
    if (!pausable_ || pace_ == last_view) return;
    pace_ = last_view;
    ++facts_version_;
  }
  tell();
}

ViewedRun::Facts ViewedRun::facts() const {
  const std::lock_guard lock(mutex_);
  Json facts = {{"name", name_}, {"note", note_}, {"pausable", pausable_}};
  facts["config"] = config_ ? json_of(*config_) : Json(nullptr);
  facts["stop"] =
      stop_
          ? Json{{"reason", stop_->stop_reason}, {"detail", stop_->detail}, {"views", stop_->views}}
          : Json(nullptr);
  facts["paused_after"] = pace_ == kAnyView ? Json(nullptr) : Json(pace_);
  return {facts_version_, text_of(facts)};
}

std::optional<run_config_t> ViewedRun::config() const {
  const std::lock_guard lock(mutex_);
  return config_;
}

int ViewedRun::views() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(views_.size());
}

std::string ViewedRun::rows(int first_view, int most) const {
  const std::lock_guard lock(mutex_);
  std::string rows = "[";
  const auto last =
      std::min<std::size_t>(views_.size(), static_cast<std::size_t>(first_view - 1 + most));
  for (auto view = static_cast<std::size_t>(first_view - 1); view < last; ++view) {
    if (rows.size() > 1) rows += ',';
    rows += views_[view].row;
  }
  return rows + "]";
}

ViewedRun::Changes ViewedRun::changes(int view, std::vector<std::int32_t>& have, std::size_t& first,
                                      std::size_t enough) const {
  const std::lock_guard lock(mutex_);
  Changes changes;
  have.resize(history_.blocks(), 0);
  for (; first < history_.blocks() && changes.bytes.size() < enough; ++first) {
    const int since = history_.since(first, view);
    if (have[first] == since) continue;
    have[first] = since;
    for (const std::int16_t value : history_.coordinate(first)) append_number(changes.bytes, value);
    append_number(changes.bytes,
                  static_cast<std::uint16_t>(history_.bytes(first, view) / kSurfaceVoxelBytes));
    history_.read(first, view, changes.bytes);
    ++changes.blocks;
  }
  changes.all = first == history_.blocks();
  return changes;
}

std::vector<std::uint8_t> ViewedRun::scan(int view) const {
  const std::lock_guard lock(mutex_);
  std::vector<std::uint8_t> bytes;
  if (view >= 1 && static_cast<std::size_t>(view) <= views_.size()) {
    file_.read(views_[static_cast<std::size_t>(view - 1)].scan, bytes);
  }
  return bytes;
}

int ViewedRun::after_version(int view) const {
  const std::lock_guard lock(mutex_);
  const auto place = static_cast<std::size_t>(view);
  return place < after_.size() ? after_[place].version : 0;
}

ViewedRun::After ViewedRun::after(int view) const {
  const std::lock_guard lock(mutex_);
  const auto place = static_cast<std::size_t>(view);
  After after;
  if (place >= after_.size()) return after;
  after.version = after_[place].version;
  file_.read(after_[place].tried, after.tried);
  std::vector<std::uint8_t> next;
  file_.read(after_[place].next, next);
  after.next.assign(next.begin(), next.end());
  return after;
}

std::size_t ViewedRun::memory_bytes() const {
  const std::lock_guard lock(mutex_);
  std::size_t bytes = history_.memory_bytes() + views_.capacity() * sizeof(KeptView) +
                      after_.capacity() * sizeof(AfterView);
  for (const KeptView& view : views_) bytes += view.row.capacity();
  return bytes;
}

std::uint64_t ViewedRun::file_bytes() const {
  const std::lock_guard lock(mutex_);
  return file_.size();
}

}  // namespace nextview
