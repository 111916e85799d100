#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "mapper/lazy_array.h"
#include "planner/prediction/surface_gain.h"
#include "planner/shortest_paths.h"

namespace nextview {

/// A position and the best view from it.
struct CandidateView {
  VoxelIndex voxel = VoxelIndex::Zero();
  double path_m = 0.0;  ///< length of the way there
  ExpectedView view;
  double value = 0.0;  ///< voxels the view is expected to add, of quality or surface
  double score = 0.0;  ///< the value, less the more the longer the way
};

/// Every so many voxels of what a path leads to, and the present position.
struct PositionLattice {
  VoxelIndex origin = VoxelIndex::Zero();
  int spacing = 1;
  std::vector<VoxelIndex> voxels;  ///< the present one first, then nearest first

  PositionLattice(const ShortestPaths& paths, const VoxelIndex& present, const VoxelIndex& origin,
                  int spacing);
  bool holds(const VoxelIndex& voxel) const;
};

/// Finds the positions from which most is to be seen, judging only those it has to.
///
/// What was found at a position is kept, with the blocks of the map it depends on, and holds until
/// one of them changes. Afterwards it still serves as a guess of the most that may be found there:
/// positions are taken from a queue in the order of their guesses, and judged again when their turn
/// comes, until the best have been judged. Guesses older than kMaxAge_views and positions never
/// judged come first.
class ViewCandidates {
 public:
  static constexpr int kMaxAge_views = 10;
  static constexpr double kOffLattice = 4.0;

  /// @param path_cost_per_m lambda: the score is value exp(-lambda path)
  ViewCandidates(SurfaceGain& gain, double path_cost_per_m)
      : gain_(gain), path_cost_per_m_(path_cost_per_m) {}

  /// Forgets everything: offsets mean other voxels from now on.
  void begin_with(const SurfaceGain::Known& known);
  /// To be called before each decision. `view` counts them, from 1.
  void begin_view(int view);
  /// What is seen of the voxels at these offsets has changed.
  void offsets_changed(const SurfaceGain::Known& known, std::span<const std::uint32_t> offsets);

  /// The best positions by score, at most so many, best first; only those of positive value.
  std::vector<CandidateView> best(const SurfaceGain::Known& known, const ShortestPaths& paths,
                                  std::span<const VoxelIndex> voxels, std::size_t count);
  /// The view of the largest value whatever the way, all positions judged that have to be.
  CandidateView most_valuable(const SurfaceGain::Known& known, const ShortestPaths& paths,
                              std::span<const VoxelIndex> voxels);
  /// A position off the lattice whose view is of at least so much value, the nearest, when no
  /// position on the lattice is; nothing when there is none either. All positions a path leads to
  /// are looked at, but judged only where it can be: off the lattice a view is taken to be of at
  /// most kOffLattice times the value of the best from the corners of the lattice's cell around it,
  /// as far as paths lead there.
  std::optional<CandidateView> off_lattice(const SurfaceGain::Known& known,
                                           const ShortestPaths& paths,
                                           const PositionLattice& lattice, double least_value);
  /// Judges one position.
  CandidateView judge(const SurfaceGain::Known& known, const ShortestPaths& paths,
                      const VoxelIndex& voxel);

  /// The positions judged since begin_view.
  const std::vector<CandidateView>& judged() const { return judged_; }

 private:
  struct Judgement {
    ExpectedView view;
    double value = 0.0;
    int made_in = 0;   // view; 0: never
    int holds_in = 0;  // last view in which it was found to hold still
    std::vector<std::uint32_t> blocks;
    Panorama::Packets finished{};  // of the panorama
  };
  double most_off_lattice(const SurfaceGain::Known& known, const ShortestPaths& paths,
                          const PositionLattice& lattice, const VoxelIndex& voxel);
  bool holds(Judgement& judgement) const;
  const Judgement& judgement_at(const SurfaceGain::Known& known, const VoxelIndex& voxel,
                                double path_m);
  CandidateView candidate(const Judgement& judgement, const VoxelIndex& voxel, double path_m) const;
  std::uint64_t key(const SurfaceGain::Known& known, const VoxelIndex& voxel) const {
    return known.field.offset(voxel);
  }

  SurfaceGain& gain_;
  double path_cost_per_m_;
  int view_ = 0;
  std::vector<CandidateView> judged_;
  LazyArray<std::int32_t> changed_in_;  // by block: the last view in which it has changed
  std::unordered_map<std::uint64_t, Judgement> judgements_;  // by offset
};

}  // namespace nextview
