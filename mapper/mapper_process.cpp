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

}  // namespace

MapperProcess::MapperProcess(Bus& bus, const run_config_t& config)
    : bus_(bus),
      config_(config),
      builder_(grid_of(config), window_of(config)),
      history_(builder_.map()) {
  bus_.on<range_image_t>([this](const range_image_t& part) { receive(part); });
}

void MapperProcess::receive(const range_image_t& part) {
  check_fits_run(part, config_);
  if (part.view < next_view_) return;
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

void MapperProcess::fold(const ReceivedRangeImage& received) {
  const auto start = Clock::now();
  const FoldReport& report = builder_.fold(received.image);
  const double update_wall_s = seconds_since(start);
  commit_t commit = commit_message(received, report, builder_.statistics());
  const auto digest_start = Clock::now();
  commit.map_digest = builder_.digest();
  const double digest_wall_s = seconds_since(digest_start);
  commit.history_digest = history_digest_ = history_digest(history_digest_, received);
  bus_.publish(commit);
  bus_.publish(timing_message(bus_.role(), received.utime, received.view, received.attempt,
                              {{"update", update_wall_s}, {"digest", digest_wall_s}}));
  history_.view_folded(next_view_, report);
  utime_ = received.utime;
  ++next_view_;
}

// An answer is all of one view: what is folded while it is published waits for the next.
bool MapperProcess::publish_blocks() {
  if (blocks_.empty()) {
    if (blocks_wanted_.empty()) return false;
    const int view = next_view_ - 1;
    const int since = std::min(*blocks_wanted_.begin(), view);
    blocks_wanted_.erase(blocks_wanted_.begin());
    std::ranges::move(map_blocks_messages(builder_.map(), history_, view, since, utime_),
                      std::back_inserter(blocks_));
  }
  bus_.publish(std::move(blocks_.front()));
  blocks_.pop_front();
  return true;
}

void MapperProcess::ask_again() {
  if (!waiting_.empty() || behind()) bus_.request<range_image_t>(next_view_, 0);
}

void MapperProcess::on_missing(const request_t& request) {
  if (request.wanted_channel == Channel<commit_t>::name) {
    bus_.request<range_image_t>(request.view, request.attempt);
  }
  // Whoever asks again before the answer begins gets one.
  if (request.wanted_channel == Channel<map_blocks_t>::name) blocks_wanted_.insert(request.view);
}

}  // namespace nextview
