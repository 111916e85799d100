#include "planner/last_look.h"

#include <algorithm>
#include <tuple>

namespace nextview {

namespace {

constexpr int kCoarsest = 4;  // voxels
/// So many positions are predicted together, which bounds the memory their counts take.
constexpr std::size_t kTogether = 256;

bool is_on(int spacing, const VoxelIndex& voxel) {
  return voxel[0] % spacing == 0 && voxel[1] % spacing == 0 && voxel[2] % spacing == 0;
}

// The best views from these voxels that have a fitness above some.
std::vector<LastLook::View> views_above(double fitness, const VoxelGrid& grid,
                                        const std::vector<VoxelIndex>& voxels,
                                        ViewEvaluator& evaluator) {
  std::vector<LastLook::View> result;
  std::vector<Eigen::Vector3d> together_m;
  for (std::size_t i = 0; i < voxels.size(); i += together_m.size()) {
    together_m.clear();
    const std::size_t end = std::min(i + kTogether, voxels.size());
    for (std::size_t j = i; j < end; ++j) together_m.push_back(grid.center_m(voxels[j]));
    evaluator.evaluate(together_m);
    for (std::size_t j = i; j < end; ++j) {
      const BestView& best = evaluator.at(together_m[j - i]);
      if (best.any && best.fitness.value > fitness) result.push_back({voxels[j], best});
    }
  }
  return result;
}

std::vector<VoxelIndex> voxels_of(const std::vector<LastLook::View>& views) {
  std::vector<VoxelIndex> voxels;
  voxels.reserve(views.size());
  for (const LastLook::View& view : views) voxels.push_back(view.voxel);
  return voxels;
}

}  // namespace

std::optional<LastLook::View> LastLook::best_view(const Situation& situation,
                                                  const ShortestPaths& paths, ViewEvaluator& coarse,
                                                  ViewEvaluator& evaluator) {
  const VoxelMap& map = situation.space.map();
  const auto may_go_to = [&](const VoxelIndex& voxel) {
    return paths.length_m(voxel) != ShortestPaths::kUnreachable &&
           std::ranges::none_of(situation.refused, [&](const SensorPose& refused) {
             return map.grid().voxel_of(refused.position_m) == voxel;
           });
  };
  std::vector<VoxelIndex> voxels = voxels_of(good_);
  std::erase_if(voxels, [&](const VoxelIndex& voxel) { return !may_go_to(voxel); });
  good_ = views_above(kGoodFitness, map.grid(), voxels, evaluator);
  voxels_asked_ = voxels.size();
  for (int spacing = kCoarsest; spacing >= 1 && good_.empty(); spacing /= 2) {
    voxels.clear();
    for (const VoxelIndex& voxel : paths.reached()) {
      const bool asked = spacing < kCoarsest && is_on(2 * spacing, voxel);
      if (is_on(spacing, voxel) && !asked && may_go_to(voxel)) voxels.push_back(voxel);
    }
    const auto worth_asking = voxels_of(views_above(kWorthAsking, map.grid(), voxels, coarse));
    good_ = views_above(kGoodFitness, map.grid(), worth_asking, evaluator);
    voxels_asked_ += voxels.size();
  }
  if (good_.empty()) return std::nullopt;
  const View best = *std::ranges::min_element(good_, {}, [&](const View& view) {
    return std::tuple(times_chosen(map, view), -view.best.fitness.value);
  });
  ++times_chosen(map, best);
  return best;
}

}  // namespace nextview
