#include "scoring/cover_bound.h"

#include <ClpSimplex.hpp>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "scoring/cover_prices.h"
#include "scoring/greedy_cover.h"

namespace nextview {
namespace {

/// The programme over some of the poses.
class Programme {
 public:
  /// @param voxels left to cover, numbered by row
  Programme(const CoverSets& sets, const std::vector<std::uint8_t>& done, double to_cover)
      : sets_(&sets), row_of_voxel_(sets.weights.size(), -1) {
    for (std::size_t voxel = 0; voxel < done.size(); ++voxel) {
      if (done[voxel] != 0) continue;
      row_of_voxel_[voxel] = static_cast<int>(weights_.size());
      weights_.push_back(static_cast<double>(sets.weights[voxel]));
    }
    // z_v, with -1 in its own row and its weight in the last.
    const int rows = static_cast<int>(weights_.size());
    std::vector<CoinBigIndex> begin = {0};
    std::vector<int> row_of;
    std::vector<double> elements;
    for (int row = 0; row < rows; ++row) {
      row_of.insert(row_of.end(), {row, rows});
      elements.insert(elements.end(), {-1.0, weights_[static_cast<std::size_t>(row)]});
      begin.push_back(static_cast<CoinBigIndex>(row_of.size()));
    }
    const std::vector<double> zeros(weights_.size() + 1, 0.0);
    const std::vector<double> ones(weights_.size(), 1.0);
    std::vector<double> least = zeros;
    least.back() = to_cover;
    const std::vector<double> no_most(weights_.size() + 1, COIN_DBL_MAX);
    clp_.setLogLevel(0);
    clp_.loadProblem(rows, rows + 1, begin.data(), row_of.data(), elements.data(), zeros.data(),
                     ones.data(), zeros.data(), least.data(), no_most.data());
  }

  void add(const std::vector<std::size_t>& poses) {
    std::vector<CoinBigIndex> begin = {0};
    std::vector<int> rows;
    for (const std::size_t pose : poses) {
      sets_->for_each_covered(pose, [&](std::uint32_t voxel) {
        if (row_of_voxel_[voxel] >= 0) rows.push_back(row_of_voxel_[voxel]);
      });
      begin.push_back(static_cast<CoinBigIndex>(rows.size()));
    }
    const std::vector<double> elements(rows.size(), 1.0);
    const std::vector<double> zeros(poses.size(), 0.0);
    const std::vector<double> ones(poses.size(), 1.0);
    const std::vector<double> no_most(poses.size(), COIN_DBL_MAX);
    clp_.addColumns(static_cast<int>(poses.size()), zeros.data(), no_most.data(), ones.data(),
                    begin.data(), rows.data(), elements.data());
  }

  /// @return the value of the dual solution, whose y_v price() uses
  double solve() {
    clp_.primal();
    if (!clp_.isProvenOptimal()) throw std::runtime_error("the linear programme was not solved");
    // From the dual values and not the objective, so that rounding in the solver cannot raise it.
    const double* dual = clp_.dualRowSolution();
    const std::size_t rows = weights_.size();
    const double lambda = std::max(0.0, dual[rows]);
    double value = lambda * clp_.rowLower()[rows];
    for (std::size_t row = 0; row < rows; ++row) {
      value -= std::max(0.0, lambda * weights_[row] - std::max(0.0, dual[row]));
    }
    return value;
  }

  double price(std::size_t pose) const {
    const double* dual = clp_.dualRowSolution();
    double sum = 0.0;
    sets_->for_each_covered(pose, [&](std::uint32_t voxel) {
      const int row = row_of_voxel_[voxel];
      if (row >= 0) sum += std::max(0.0, dual[row]);
    });
    return sum;
  }

 private:
  const CoverSets* sets_;
  std::vector<int> row_of_voxel_;
  std::vector<double> weights_;
  ClpSimplex clp_;
};

/// Of every so many consecutive poses the one with the highest price: what they cover is alike.
std::vector<std::size_t> dearest_of_alike(const std::vector<double>& prices, std::size_t alike) {
  std::vector<std::size_t> dearest;
  for (std::size_t first = 0; first < prices.size(); first += alike) {
    const auto begin = prices.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = begin + static_cast<std::ptrdiff_t>(std::min(alike, prices.size() - first));
    dearest.push_back(static_cast<std::size_t>(std::max_element(begin, end) - prices.begin()));
  }
  return dearest;
}

}  // namespace

double fewest_poses(const CoverSets& sets, std::span<const std::size_t> first, double share,
                    const CoverBoundParameters& parameters, const std::stop_token& stop,
                    WorkProgress* progress) {
  std::vector<std::uint8_t> done(sets.weights.size(), 0);
  double to_cover = share * static_cast<double>(sets.total_weight());
  for (const std::size_t pose : first) {
    sets.for_each_covered(pose, [&](std::uint32_t voxel) {
      if (done[voxel] == 0) to_cover -= static_cast<double>(sets.weights[voxel]);
      done[voxel] = 1;
    });
  }
  if (to_cover <= 0.0) return 0.0;
  std::vector<std::size_t> added = greedy_cover(sets, first, share, stop);
  if (stop.stop_requested()) return 0.0;
  if (share_covered(sets, added) < share) {
    throw std::invalid_argument("the poses do not cover the share that was asked for");
  }
  added.erase(added.begin(), added.begin() + static_cast<std::ptrdiff_t>(first.size()));
  const auto rows = static_cast<std::size_t>(std::count(done.begin(), done.end(), 0));
  if (rows > parameters.most_voxels) {
    return bound_by_prices(sets, done, to_cover, parameters.prices, stop, progress);
  }

  Programme programme(sets, done, to_cover);
  std::vector<std::uint8_t> is_in(sets.poses(), 0);
  std::vector<double> prices(sets.poses());
  double bound = 0.0;
  if (progress != nullptr) progress->begin("bound on views, in rounds", 0);
  for (int round = 0; round < parameters.most_rounds && !stop.stop_requested(); ++round) {
    if (progress != nullptr) progress->done = round;
    programme.add(added);
    for (const std::size_t pose : added) is_in[pose] = 1;
    const double value = programme.solve();
    for (std::size_t pose = 0; pose < prices.size(); ++pose) prices[pose] = programme.price(pose);
    const double dearest = std::max(1.0, *std::max_element(prices.begin(), prices.end()));
    bound = std::max(bound, value / dearest);
    // As whole poses it cannot become more.
    if (std::ceil(bound - 1e-6) >= std::ceil(value - 1e-6)) break;
    added = dearest_of_alike(prices, parameters.alike);
    std::erase_if(added,
                  [&](std::size_t pose) { return is_in[pose] != 0 || prices[pose] <= 1.0 + 1e-7; });
    if (added.empty()) break;
    const std::size_t some = std::min(added.size(), parameters.poses_a_round);
    std::partial_sort(added.begin(), added.begin() + static_cast<std::ptrdiff_t>(some), added.end(),
                      [&](std::size_t a, std::size_t b) {
                        return std::pair(-prices[a], a) < std::pair(-prices[b], b);
                      });
    added.resize(some);
  }
  return bound;
}

}  // namespace nextview
