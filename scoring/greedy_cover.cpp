#include "scoring/greedy_cover.h"

#include <queue>
#include <utility>

namespace nextview {
namespace {

/// What is covered so far.
class Covered {
 public:
  explicit Covered(const CoverSets& sets) : sets_(&sets), covered_(sets.weights.size(), 0) {}

  std::int64_t gain_of(std::size_t pose) const {
    std::int64_t gain = 0;
    sets_->for_each_covered(pose, [&](std::uint32_t voxel) {
      if (covered_[voxel] == 0) gain += sets_->weights[voxel];
    });
    return gain;
  }
  void take(std::size_t pose) {
    weight_ += gain_of(pose);
    sets_->for_each_covered(pose, [&](std::uint32_t voxel) { covered_[voxel] = 1; });
  }
  std::int64_t weight() const { return weight_; }

 private:
  const CoverSets* sets_;
  std::vector<std::uint8_t> covered_;
  std::int64_t weight_ = 0;
};

}  // namespace

std::vector<std::size_t> greedy_cover(const CoverSets& sets, std::span<const std::size_t> first,
                                      double share, const std::stop_token& stop) {
  std::vector<std::size_t> taken;
  Covered covered(sets);
  const auto take = [&](std::size_t pose) {
    covered.take(pose);
    taken.push_back(pose);
  };
  const double enough = share * static_cast<double>(sets.total_weight());
  const auto is_enough = [&] { return static_cast<double>(covered.weight()) >= enough; };
  for (const std::size_t pose : first) take(pose);

  // A pose never gains more than it did before, so the best is found without asking all again.
  struct Bound {
    std::int64_t gain;
    std::size_t pose;
    bool operator<(const Bound& other) const {
      return std::pair(gain, other.pose) < std::pair(other.gain, pose);
    }
  };
  std::priority_queue<Bound> queue;
  for (std::size_t pose = 0; pose < sets.poses(); ++pose) queue.push({covered.gain_of(pose), pose});
  while (!is_enough() && !queue.empty() && !stop.stop_requested()) {
    Bound best = queue.top();
    queue.pop();
    best.gain = covered.gain_of(best.pose);
    if (best.gain == 0) continue;
    if (queue.empty() || !(best < queue.top())) {
      take(best.pose);
    } else {
      queue.push(best);
    }
  }
  return taken;
}

double share_covered(const CoverSets& sets, std::span<const std::size_t> poses) {
  Covered covered(sets);
  for (const std::size_t pose : poses) covered.take(pose);
  return static_cast<double>(covered.weight()) / static_cast<double>(sets.total_weight());
}

}  // namespace nextview
