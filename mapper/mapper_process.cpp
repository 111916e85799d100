#include "mapper/mapper_process.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "lcmtypes/timing_message.h"
#include "mapper/commit_message.h"
#include "mapper/map_blocks_message.h"
#include "mapper/mapper_config.h"

namespace nextview {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::variant<MapBuilder, PagedMapBuilder> make_builder(const run_config_t& config,
                                                       const std::optional<VoxelIndex>& window) {
  const MapWindow whole = window_of(config);
  if (window && (window->array() < whole.size.array()).any()) {
    return PagedMapBuilder(grid_of(config), whole, *window);
  }
  return MapBuilder(grid_of(config), whole);
}

}  // namespace

MapperProcess::MapperProcess(Bus& bus, const run_config_t& config,
                             const std::optional<VoxelIndex>& window)
    : bus_(bus),
      config_(config),
      builder_(make_builder(config, window)),
      course_(config, Channel<range_image_t>::name) {
  if (const auto* builder = std::get_if<MapBuilder>(&builder_)) history_.emplace(builder->map());
  bus_.on<goal_t>([this](const goal_t& goal) { course().add(goal); });
  bus_.on<arrival_t>([this](const arrival_t& arrival) { course().add(arrival); });
  bus_.on<range_image_t>([this](const range_image_t& part) { receive(part); });
}

RunCourse& MapperProcess::course() {
  course_.at_view(std::max(next_view_, reached() + 1));
  return course_;
}

void MapperProcess::receive(const range_image_t& part) {
  if (part.view < next_view_) return;
  check_fits_run(part, config_);
  course().check(part);
  if (auto image = assembler_.add(part)) waiting_.emplace(part.view, std::move(*image));
}

bool MapperProcess::step() {
  const auto next = waiting_.find(next_view_);
  if (next == waiting_.end()) return publish_blocks();
  const ReceivedRangeImage received = std::move(next->second);
  waiting_.erase(next);
  fold(received);
  return true;
}

FoldCounts MapperProcess::fold_into_map(const RangeImage& image) {
  if (auto* paged = std::get_if<PagedMapBuilder>(&builder_)) return paged->fold(image);
  const FoldReport& report = std::get<MapBuilder>(builder_).fold(image);
  history_->view_folded(next_view_, report);
  return report;
}

void MapperProcess::fold(const ReceivedRangeImage& received) {
  const auto start = Clock::now();
  const FoldCounts folded = fold_into_map(received.image);
  const double update_wall_s = seconds_since(start);
  const auto statistics = [](const auto& builder) { return builder.statistics(); };
  commit_t commit = commit_message(received, folded, std::visit(statistics, builder_));
  const auto digest_start = Clock::now();
  commit.map_digest = std::visit([](auto& builder) { return builder.digest(); }, builder_);
  const double digest_wall_s = seconds_since(digest_start);
  commit.history_digest = history_digest_ = history_digest(history_digest_, received);
  bus_.publish(commit);
  bus_.publish(timing_message(bus_.role(), received.utime, received.view, received.attempt,
                              {{"update", update_wall_s}, {"digest", digest_wall_s}}));
  utime_ = received.utime;
  assembler_.forget_until(next_view_);
  waiting_.erase(waiting_.begin(), waiting_.upper_bound(next_view_));
  ++next_view_;
  bus_.ignore_before<range_image_t>(next_view_);
  bus_.ignore_before<arrival_t>(next_view_);
  bus_.ignore_before<goal_t>(next_view_);
  course_.forget_before(next_view_);
}

// An answer is all of one view: what is folded while it is published waits for the next.
bool MapperProcess::publish_blocks() {
  if (blocks_.empty()) {
    if (blocks_wanted_.empty()) return false;
    const int view = next_view_ - 1;
    const int since = std::min(*blocks_wanted_.begin(), view);
    blocks_wanted_.erase(blocks_wanted_.begin());
    const auto* const paged = std::get_if<PagedMapBuilder>(&builder_);
    std::ranges::move(paged != nullptr ? map_blocks_messages(*paged, view, since, utime_)
                                       : map_blocks_messages(std::get<MapBuilder>(builder_).map(),
                                                             *history_, view, since, utime_),
                      std::back_inserter(blocks_));
  }
  bus_.publish(std::move(blocks_.front()));
  blocks_.pop_front();
  return true;
}

void MapperProcess::ask_again() {
  if (waits()) request_range_image(bus_, assembler_, next_view_, 0);
}

bool MapperProcess::waits() const {
  return !waiting_.empty() || behind() || asked_for_view_ >= next_view_ ||
         assembler_.has_part_of(next_view_);
}

void MapperProcess::on_missing(const request_t& request) {
  if (request.wanted_channel == Channel<commit_t>::name) {
    asked_for_view_ = std::max(asked_for_view_, request.view);
    request_range_image(bus_, assembler_, request.view, request.attempt);
  }
  // Whoever asks again before the answer begins gets one.
  if (request.wanted_channel == Channel<map_blocks_t>::name) {
    blocks_wanted_.insert(std::min(request.view, next_view_ - 1));
  }
}

}  // namespace nextview
