#include "bench/exploration.h"

#include <numbers>
#include <utility>

#include "bench/stopwatch.h"
#include "planner/prediction/fast_view_predictor.h"
#include "planner/prediction/orientations.h"
#include "sensor_sim/scan.h"

namespace nextview {

TiltedLineScan sensor_for(double voxel_size_m) {
  if (voxel_size_m >= 0.10) return TiltedLineScan::paper();
  constexpr double kAperture_rad = std::numbers::pi / 3.0;
  return voxel_size_m >= 0.05 ? TiltedLineScan::with_aperture(128, 60, kAperture_rad)
                              : TiltedLineScan::with_aperture(320, 150, kAperture_rad);
}

std::unique_ptr<Strategy> paper_strategy(const ExplorationParameters& parameters, int threads) {
  const auto predictor = [&](int columns, int rows, bool counts_surfaces) {
    const auto sensor = TiltedLineScan::with_aperture(columns, rows, std::numbers::pi / 3.0);
    return std::make_unique<FastViewPredictor>(prediction_raster(sensor, RangeLimits()),
                                               parameters.voxel_size_m, icosahedron_orientations(),
                                               counts_surfaces, threads);
  };
  return std::make_unique<PaperStrategy>(
      parameters.planner, StopParameters(), parameters.voxel_size_m,
      predictor(64, 30, ask_for_surfaces(parameters.planner.weights)), predictor(16, 7, false));
}

Exploration::Exploration(const BenchScene& scene, const ExplorationParameters& parameters)
    : Exploration(scene, parameters, paper_strategy(parameters)) {}

Exploration::Exploration(const BenchScene& scene, const ExplorationParameters& parameters,
                         std::unique_ptr<Strategy> strategy)
    : scene_(scene),
      parameters_(parameters),
      rays_(make_ray_table(parameters.sensor)),
      planner_({parameters.voxel_size_m},
               window_around(scene.scene.mesh(), parameters.voxel_size_m), std::move(strategy),
               {.seed = parameters.seed, .max_views = 1'000'000}),
      pose_(scene.start) {}

ViewCost Exploration::step() {
  ViewCost cost;
  cost.view = planner_.views() + 1;
  RandomStream no_noise(parameters_.seed, cost.view, 1, RandomPurpose::RangeNoise);
  image_ = scan(scene_.scene, rays_, RangeLimits(), pose_, 0.0, no_noise);
  cost.fold_s = wall_s([&] { planner_.fold(image_); });
  cost.digest_s = wall_s([&] { planner_.builder().digest(); });
  cost.field_s = wall_s([&] { planner_.space(); });
  const Decision* decision = nullptr;
  cost.decision_s = wall_s([&] { decision = std::get_if<Decision>(&planner_.next_view()); });
  cost.moved = decision != nullptr;
  if (decision != nullptr) {
    cost.evaluations = decision->evaluations;
    pose_ = decision->pose;
  } else {
    pose_.pan_rad += 0.7;  // look elsewhere
  }
  return cost;
}

void Exploration::carry_elsewhere() {
  const VoxelMap& map = planner_.map();
  RandomStream random(parameters_.seed, views(), 1, RandomPurpose::InitialSimplex);
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
