#include "scoring/cover_prices.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

namespace nextview {
namespace {

/// So often it is asked anew from which price on more does not help.
constexpr int kStepsACap = 10;

/// What each voxel costs: w_v times a share that falls with every pose that covers it, and is never
/// above a cap, lambda.
class Prices {
 public:
  Prices(const CoverSets& sets, const std::vector<std::uint8_t>& done, double to_cover, double fall)
      : sets_(&sets), to_cover_(to_cover), times_(done.size(), 0), price_(done.size(), 0.0) {
    share_after_ = {1.0};
    fall_ = fall;
    weight_after_ = {0.0};
    for (std::size_t voxel = 0; voxel < done.size(); ++voxel) {
      if (done[voxel] != 0) continue;
      price_[voxel] = static_cast<double>(sets.weights[voxel]);
      weight_after_[0] += price_[voxel];
    }
  }

  double of(std::size_t pose) const {
    double sum = 0.0;
    sets_->for_each_covered(pose, [&](std::uint32_t voxel) { sum += price_[voxel]; });
    return sum;
  }

  void take(std::size_t pose) {
    sets_->for_each_covered(pose, [&](std::uint32_t voxel) {
      if (price_[voxel] == 0.0) return;
      const double weight = static_cast<double>(sets_->weights[voxel]);
      const std::size_t times = ++times_[voxel];
      if (times == share_after_.size()) {
        share_after_.push_back(share_after_.back() * (1.0 - fall_));
        weight_after_.push_back(0.0);
      }
      weight_after_[times - 1] -= weight;
      weight_after_[times] += weight;
      price_[voxel] = weight * std::min(cap_, share_after_[times]);
    });
  }

  /// Whoever covers enough leaves out at most so much weight; what is left out is best what is
  /// dearest, and so above the cap no price counts.
  void set_cap() {
    double weight = 0.0;
    std::size_t times = weight_after_.size();
    while (times > 0 && weight < to_cover_) weight += weight_after_[--times];
    if (share_after_[times] >= cap_) return;
    cap_ = share_after_[times];
    for (std::size_t voxel = 0; voxel < price_.size(); ++voxel) {
      price_[voxel] = std::min(price_[voxel], cap_ * static_cast<double>(sets_->weights[voxel]));
    }
  }

  /// Least that covering enough costs.
  double least() const {
    double least = cap_ * to_cover_;
    for (std::size_t times = 0; times < weight_after_.size(); ++times) {
      least -= weight_after_[times] * std::max(0.0, cap_ - share_after_[times]);
    }
    return least;
  }

 private:
  const CoverSets* sets_;
  double to_cover_;
  double fall_;
  double cap_ = 1.0;
  std::vector<std::uint32_t> times_;  ///< by voxel: how often it has been covered
  std::vector<double> price_;         ///< by voxel
  std::vector<double> share_after_;   ///< by times
  std::vector<double> weight_after_;  ///< by times: of all voxels
};

}  // namespace

double bound_by_prices(const CoverSets& sets, const std::vector<std::uint8_t>& done,
                       double to_cover, const CoverPriceParameters& parameters,
                       const std::stop_token& stop, WorkProgress* progress) {
  Prices prices(sets, done, to_cover, parameters.fall);
  struct Offer {
    double most;
    std::size_t pose;
    bool operator<(const Offer& other) const {
      return std::pair(most, other.pose) < std::pair(other.most, pose);
    }
  };
  std::vector<Offer> offers;
  for (std::size_t pose = 0; pose < sets.poses() && !stop.stop_requested(); ++pose) {
    offers.push_back({prices.of(pose), pose});
  }
  std::priority_queue<Offer> queue(std::less<Offer>(), std::move(offers));
  double bound = 0.0;
  if (progress != nullptr) progress->begin("bound on views", parameters.most_steps);
  for (int step = 0; step < parameters.most_steps && !stop.stop_requested(); ++step) {
    if (step % kStepsACap == 0) prices.set_cap();
    Offer dearest = queue.top();
    for (double now = prices.of(dearest.pose); now < dearest.most; now = prices.of(dearest.pose)) {
      queue.pop();
      queue.push({now, dearest.pose});
      dearest = queue.top();
    }
    bound = std::max(bound, prices.least() / dearest.most);
    prices.take(dearest.pose);
    if (progress != nullptr) ++progress->done;
  }
  return bound;
}

}  // namespace nextview
