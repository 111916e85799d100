#include "bench/exploration.h"

#include <numbers>

#include "bench/stopwatch.h"
#include "sensor_sim/scan.h"

namespace nextview {

TiltedLineScan sensor_for(double voxel_size_m) {
  if (voxel_size_m >= 0.10) return TiltedLineScan::paper();
  constexpr double kAperture_rad = std::numbers::pi / 3.0;
  return voxel_size_m >= 0.05 ? TiltedLineScan::with_aperture(128, 60, kAperture_rad)
                              : TiltedLineScan::with_aperture(320, 150, kAperture_rad);
}

Exploration::Exploration(const BenchScene& scene, const ExplorationParameters& parameters)
    : scene_(scene),
      parameters_(parameters),
      rays_(make_ray_table(parameters.sensor)),
      builder_({parameters.voxel_size_m},
               window_around(scene.scene.mesh(), parameters.voxel_size_m)),
      pose_(scene.start) {}

ViewCost Exploration::step(ViewPredictor& predictor) {
  ViewCost cost;
  cost.view = ++view_;
  RandomStream no_noise(parameters_.seed, view_, 1, RandomPurpose::RangeNoise);
  image_ = scan(scene_.scene, rays_, RangeLimits(), pose_, 0.0, no_noise);
  const FoldReport* report = nullptr;
  cost.fold_s = wall_s([&] { report = &builder_.fold(image_); });
  cost.digest_s = wall_s([&] { builder_.digest(); });
  const VoxelMap& map = builder_.map();
  cost.field_s =
      wall_s([&] { predictor.map_changed(map, report->changed_slots, report->updated_surfaces); });
  std::optional<Decision> decision;
  cost.decision_s = wall_s([&] {
    decision = decide_next_view(map, predictor, parameters_.planner, pose_, parameters_.seed,
                                view_ + 1, 1, {});
  });
  cost.moved = decision.has_value();
  if (decision) {
    cost.evaluations = decision->evaluations;
    pose_ = decision->pose;
  } else {
    pose_.pan_rad += 0.7;  // look elsewhere
  }
  return cost;
}

void Exploration::carry_elsewhere() {
  const VoxelMap& map = builder_.map();
  RandomStream random(parameters_.seed, view_, 1, RandomPurpose::InitialSimplex);
  constexpr int kDraws = 100000;
  for (int draw = 0; draw < kDraws; ++draw) {
    VoxelIndex voxel = map.window().min;
    for (int axis = 0; axis < 3; ++axis) {
      voxel[axis] +=
          static_cast<int>(random.below(static_cast<std::uint32_t>(map.window().size[axis])));
    }
    if (!is_clear(map, voxel, parameters_.planner.feasibility.clearance_m)) continue;
    pose_.position_m = map.grid().center_m(voxel);
    return;
  }
}

}  // namespace nextview
