#include "planner/view_candidates.h"

#include <algorithm>
#include <queue>

#include "sensor/elementary_functions.h"

namespace nextview {

PositionLattice::PositionLattice(const ShortestPaths& paths, const VoxelIndex& present,
                                 const VoxelIndex& origin, int spacing)
    : origin(origin), spacing(spacing), voxels{present} {
  for (const VoxelIndex& voxel : paths.reached()) {
    if (holds(voxel) && voxel != present) voxels.push_back(voxel);
  }
}

bool PositionLattice::holds(const VoxelIndex& voxel) const {
  const VoxelIndex from = voxel - origin;
  return from[0] % spacing == 0 && from[1] % spacing == 0 && from[2] % spacing == 0;
}

void ViewCandidates::begin_with(const SurfaceGain::Known& known) {
  changed_in_ = LazyArray<std::int32_t>(known.field.size());
  judgements_.clear();
}

void ViewCandidates::begin_view(int view) {
  view_ = view;
  judged_.clear();
}

void ViewCandidates::offsets_changed(const SurfaceGain::Known& known,
                                     std::span<const std::uint32_t> offsets) {
  for (const std::uint32_t offset : offsets) {
    changed_in_[field_block(known.field.shifts(), offset)] = view_;
  }
}

bool ViewCandidates::holds(Judgement& judgement) const {
  if (judgement.holds_in == view_) return true;
  if (judgement.made_in == 0) return false;
  for (const std::uint32_t block : judgement.blocks) {
    if (changed_in_[block] > judgement.holds_in) return false;
  }
  judgement.holds_in = view_;
  return true;
}

const ViewCandidates::Judgement& ViewCandidates::judgement_at(const SurfaceGain::Known& known,
                                                              const VoxelIndex& voxel,
                                                              double path_m) {
  Judgement& judgement = judgements_[key(known, voxel)];
  if (holds(judgement)) return judgement;
  gain_.look_again(known, voxel, judgement.finished);
  judgement.view = gain_.best();
  judgement.value = judgement.view.value(gain_.parameters().improvement_weight);
  judgement.made_in = view_;
  judgement.holds_in = view_;
  judgement.blocks.assign(gain_.blocks().begin(), gain_.blocks().end());
  judged_.push_back(candidate(judgement, voxel, path_m));
  return judgement;
}

CandidateView ViewCandidates::candidate(const Judgement& judgement, const VoxelIndex& voxel,
                                        double path_m) const {
  return {voxel, path_m, judgement.view, judgement.value,
          judgement.value * elementary::exp(-path_cost_per_m_ * path_m)};
}

CandidateView ViewCandidates::judge(const SurfaceGain::Known& known, const ShortestPaths& paths,
                                    const VoxelIndex& voxel) {
  const double path_m = paths.length_m(voxel);
  return candidate(judgement_at(known, voxel, path_m), voxel, path_m);
}

std::vector<CandidateView> ViewCandidates::best(const SurfaceGain::Known& known,
                                                const ShortestPaths& paths,
                                                std::span<const VoxelIndex> voxels,
                                                std::size_t count) {
  struct Guess {
    double score;
    std::size_t voxel;
    bool operator<(const Guess& other) const {
      return score != other.score ? score < other.score : voxel > other.voxel;
    }
  };
  std::priority_queue<Guess> guesses;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    Judgement& judgement = judgements_[key(known, voxels[i])];
    const double path_m = paths.length_m(voxels[i]);
    const bool old =
        judgement.made_in == 0 || (view_ - judgement.made_in > kMaxAge_views && !holds(judgement));
    if (old) judgement_at(known, voxels[i], path_m);
    guesses.push({candidate(judgement, voxels[i], path_m).score, i});
  }
  std::vector<CandidateView> best;
  while (!guesses.empty() && best.size() < count && guesses.top().score > 0.0) {
    const std::size_t i = guesses.top().voxel;
    guesses.pop();
    const bool sure = holds(judgements_[key(known, voxels[i])]);
    const CandidateView judged = judge(known, paths, voxels[i]);
    if (sure) {
      best.push_back(judged);
    } else {
      guesses.push({judged.score, i});
    }
  }
  return best;
}

CandidateView ViewCandidates::most_valuable(const SurfaceGain::Known& known,
                                            const ShortestPaths& paths,
                                            std::span<const VoxelIndex> voxels) {
  CandidateView most;
  for (const VoxelIndex& voxel : voxels) {
    const CandidateView judged = judge(known, paths, voxel);
    if (judged.value > most.value) most = judged;
  }
  return most;
}

std::optional<CandidateView> ViewCandidates::off_lattice(const SurfaceGain::Known& known,
                                                         const ShortestPaths& paths,
                                                         const PositionLattice& lattice,
                                                         double least_value) {
  for (const VoxelIndex& voxel : paths.reached()) {
    if (lattice.holds(voxel)) continue;
    if (most_off_lattice(known, paths, lattice, voxel) < least_value) continue;
    const CandidateView judged = judge(known, paths, voxel);
    if (judged.value >= least_value) return judged;
  }
  return std::nullopt;
}

double ViewCandidates::most_off_lattice(const SurfaceGain::Known& known, const ShortestPaths& paths,
                                        const PositionLattice& lattice, const VoxelIndex& voxel) {
  VoxelIndex below = voxel;  // on the lattice
  for (int axis = 0; axis < 3; ++axis) {
    const int from = (voxel[axis] - lattice.origin[axis]) % lattice.spacing;
    below[axis] -= from < 0 ? from + lattice.spacing : from;
  }
  double most = -1.0;
  for (int corner = 0; corner < 8; ++corner) {
    VoxelIndex at = below;
    for (int axis = 0; axis < 3; ++axis) {
      if ((corner >> axis & 1) != 0 && below[axis] != voxel[axis]) at[axis] += lattice.spacing;
    }
    if (paths.length_m(at) == ShortestPaths::kUnreachable) continue;
    most = std::max(most, judge(known, paths, at).value);
  }
  return most < 0.0 ? std::numeric_limits<double>::infinity() : kOffLattice * most;
}

}  // namespace nextview
