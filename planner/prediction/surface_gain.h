#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mapper/lazy_array.h"
#include "planner/prediction/free_space_field.h"
#include "planner/prediction/panorama.h"
#include "planner/prediction/predicted_quality.h"
#include "planner/prediction/surface_table.h"
#include "planner/prediction/view_counts.h"
#include "planner/prediction/view_predictor.h"

namespace nextview {

class GrownSurface;

/// What a view is expected to show.
struct ExpectedView {
  std::size_t orientation = 0;
  double new_voxels = 0.0;  ///< of surface, or that may be: each distinct one once
  double improvement =
      0.0;               ///< quality, summed over distinct Occupied voxels; 0 when not asked for
  double overlap = 0.0;  ///< share of the view's cells that meet what is Occupied already

  /// What counts when views are compared, in voxels.
  double value(double improvement_weight) const {
    return new_voxels + improvement_weight * improvement;
  }
};

/// Judges all views from a position by what each would show that is not known yet, in voxels and
/// not in rays: a voxel that fills half a view is one voxel. With the panorama around the position,
///
///     new_voxels(view) = sum over the view's cells of  a t(s) / N1(s)  +  p(u) / N2(u)
///
/// where s is the unknown voxel (Unmarked, Occluded or OcclusionPlane) a cell's ray meets first, u
/// the voxel of a plane grown into the unknown (grown_surface.h) that it meets when only Occupied
/// and grown voxels stop it, N1 and N2 the cells of the whole panorama that meet s or u, t the
/// trust that is left in s after views in vain, and p(u) how likely u is. So each voxel counts once
/// altogether, and every view is one sum of cells. Sums are integers, 1/kUnit voxels.
class SurfaceGain {
 public:
  static constexpr std::int32_t kUnit = 1 << 16;

  struct Parameters {
    double unknown_weight = 0.3;      ///< a; 1 when no planes are grown
    double improvement_weight = 0.0;  ///< of quality; 0: quality is not looked at
    double min_overlap = 0.2;         ///< views that overlap less with what is known do not count
  };
  /// What is known, and what is made of it. The field, the grown planes' and all tables are of one
  /// window and so have the same offsets.
  struct Known {
    const FreeSpaceField& field;
    std::span<const std::uint8_t> in_vain;   ///< by offset: views that were to show it and did not
    const GrownSurface* grown = nullptr;     ///< may be left out
    const SurfaceTable* surfaces = nullptr;  ///< needed when quality is looked at
  };

  /// @throws std::invalid_argument for no orientations or rays, or lengths that are not positive
  SurfaceGain(const PredictionRaster& raster, double voxel_size_m,
              std::vector<Orientation> orientations, const Parameters& parameters);

  const std::vector<Orientation>& orientations() const { return orientations_; }
  const Parameters& parameters() const { return parameters_; }

  /// Looks around from a voxel of the window; what follows is about views from there.
  void look_from(const Known& known, const VoxelIndex& sensor);
  /// The same, where one has looked from before. Packets of cells that all meet what is Occupied,
  /// and nothing grown before it, are finished, for what is Occupied or Empty stays known; they
  /// need not be cast again but for planes that bridge Empty voxels. Of what counts() says they are
  /// left out.
  /// @param finished as an earlier look from there left it, and none before the first; with
  ///        improvement_weight it is not used
  void look_again(const Known& known, const VoxelIndex& sensor, Panorama::Packets& finished);
  /// The best view, of equal ones the first; value 0 when none overlaps enough.
  ExpectedView best() const;
  ExpectedView view(std::size_t orientation) const;
  /// The blocks of 8 x 8 x 8 cells of the field in which lies what may be new from here, each once:
  /// as long as nothing changes in them, looking again from here shows the same.
  std::span<const std::uint32_t> blocks() const { return blocks_; }
  /// Offsets of the distinct unknown voxels that a view is to show.
  std::vector<std::uint32_t> aimed_at(std::size_t orientation) const;
  /// What the view's cells meet, as if each were a ray.
  ViewCounts counts(const Known& known, std::size_t orientation) const;

 private:
  // How many cells meet each voxel, then what each of them counts.
  struct Tally {
    std::vector<std::uint32_t> offsets;  // of the voxels, each once
    LazyArray<std::int32_t> by_offset;   // 0 in between
  };

  ExpectedView new_in(std::size_t orientation) const;
  double overlap(std::size_t orientation) const;
  void judge(const Known& known);
  void look(const Known& known, const VoxelIndex& sensor, const Panorama::Packets& to_cast);
  void look_behind_bridges(const Known& known, const VoxelIndex& sensor);
  static void count(const Panorama::Cells& cells, const std::vector<std::int32_t>& met_at,
                    std::size_t offsets, Tally& tally);
  static void forget(Tally& tally);
  void weigh_unknown(const Known& known);
  void weigh_grown(const Known& known);
  void add_improvement(const Known& known);
  void sum_cells();
  void note_block(const Known& known, std::uint32_t offset);

  Parameters parameters_;
  std::vector<Orientation> orientations_;
  Panorama panorama_;
  PanoramaViews views_;
  std::vector<QuantisedDirection> directions_;  // of cells, for quality
  Panorama::Met met_;                           // what cells meet first; their offsets
  Panorama::Met behind_;
  std::vector<std::int32_t> grown_at_;  // by cell
  Panorama::Cells unknown_cells_{};     // that meet something unknown first
  Panorama::Cells grown_cells_{};       // whose grown_at_ holds a grown voxel
  Tally unknown_;
  Tally grown_;
  PanoramaViews::RowSums gain_sums_;
  PanoramaViews::RowSums improvement_sums_;
  LazyArray<std::uint8_t> noted_;  // by block of the field; 0 in between
  std::vector<std::uint32_t> blocks_;
};

/// The number of the block of 8 x 8 x 8 cells an offset of a field lies in.
inline std::uint32_t field_block(const std::array<int, 3>& shifts, std::uint32_t offset) {
  const auto x_bits = static_cast<std::uint32_t>(shifts[1]);
  const auto y_bits = static_cast<std::uint32_t>(shifts[2] - shifts[1]);
  const std::uint32_t x = offset & ((1u << x_bits) - 1);
  const std::uint32_t y = offset >> x_bits & ((1u << y_bits) - 1);
  const std::uint32_t z = offset >> (x_bits + y_bits);
  return x / 8 + ((y / 8 + ((z / 8) << y_bits)) << x_bits);
}

}  // namespace nextview
