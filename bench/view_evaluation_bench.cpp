// Whole fitness: the best of 20 directions at each of 60 positions, 64 x 30 rays a view.

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "bench/bench_groups.h"
#include "bench/octomap_map.h"
#include "bench/openvdb_map.h"
#include "bench/recovered_room.h"
#include "bench/textbook_ray_walk.h"
#include "mapper/integer_line.h"
#include "planner/fitness.h"
#include "planner/prediction/fast_view_predictor.h"
#include "planner/prediction/orientations.h"
#include "planner/prediction/panorama_view_predictor.h"

namespace nextview {

namespace {

using Predictor = std::shared_ptr<ViewPredictor>;

double evaluate(const KnownSpace& space, ViewPredictor& predictor,
                const std::vector<VoxelIndex>& positions, std::vector<ViewCounts>& counts) {
  FactorWeights weights = {};
  weights[kQualityFactor] = predictor.counts_surfaces() ? 1.0 : 0.0;
  double best = 0.0;
  for (const VoxelIndex& position : positions) {
    predictor.predict(space, position, counts);
    for (const ViewCounts& view : counts) {
      best = std::max(best, fitness(view, {}, weights).value);
    }
  }
  return best;
}

void set_rays(benchmark::State& state, const RecoveredRoom& room, const ViewPredictor& predictor) {
  const auto rays =
      static_cast<std::int64_t>(room.positions().size() * predictor.orientations().size() *
                                RecoveredRoom::raster().rays.pixels());
  state.SetItemsProcessed(state.iterations() * rays);
}

// While it lives, the ray kernel takes the best of a choice of instruction sets.
class InstructionSets {
 public:
  explicit InstructionSets(std::int64_t targets) { hwy::SetSupportedTargetsForTest(targets); }
  InstructionSets(const InstructionSets&) = delete;
  InstructionSets& operator=(const InstructionSets&) = delete;
  ~InstructionSets() { hwy::SetSupportedTargetsForTest(0); }
};

benchmark::internal::Benchmark* register_predictor(const std::string& name,
                                                   const RecoveredRoom& room, Predictor predictor) {
  return benchmark::RegisterBenchmark(
             ("view_evaluation/" + name + "/" + size_name(room.voxel_size_m())).c_str(),
             [&room, predictor](benchmark::State& state) {
               std::vector<ViewCounts> counts(predictor->orientations().size());
               const KnownSpace space(room.map(), KnownSpace::Surfaces::Keep);
               predictor->predict(space, room.positions().front(), counts);
               for (auto _ : state) {
                 benchmark::DoNotOptimize(evaluate(space, *predictor, room.positions(), counts));
               }
               set_rays(state, room, *predictor);
             })
      ->Unit(benchmark::kMillisecond);
}

// A scan comes before every decision: the map goes back and forth over its last scan.
void register_with_update(const RecoveredRoom& room, Predictor predictor) {
  benchmark::RegisterBenchmark(
      ("view_evaluation/nextview_with_field_update/" + size_name(room.voxel_size_m())).c_str(),
      [&room, predictor](benchmark::State& state) {
        std::vector<ViewCounts> counts(predictor->orientations().size());
        // The labels go back and forth in a map of the bench's own, which is not timed.
        VoxelMap map(room.map().grid(), room.map().window());
        const auto take = [&](const VoxelMap& other) {
          std::copy(other.labels().begin(), other.labels().end(), map.labels().begin());
        };
        take(room.map());
        KnownSpace space(map);
        bool last_scan_in = true;
        for (auto _ : state) {
          last_scan_in = !last_scan_in;
          state.PauseTiming();
          take(last_scan_in ? room.map() : room.map_before_last_scan());
          state.ResumeTiming();
          space.update(room.changed_by_last_scan(), room.surfaces_of_last_scan());
          benchmark::DoNotOptimize(evaluate(space, *predictor, room.positions(), counts));
        }
        set_rays(state, room, *predictor);
        state.counters["changed_voxels"] = static_cast<double>(room.changed_by_last_scan().size());
      })
      ->Unit(benchmark::kMillisecond);
}

Meeting plain_cast(const VoxelMap& map, const VoxelIndex& sensor, const Eigen::Vector3d& direction,
                   double reach) {
  const IntegerLine line = line_along(sensor, direction, reach);
  const int last = std::min(line.steps, steps_inside(line, map.window()));
  for (int k = 1; k <= last; ++k) {
    const Label label = map.label(line.at(k));
    if (label != Label::Empty) return meeting_of(label);
  }
  return Meeting::Open;
}

// Ray by ray: what the competitors' walks meet against the integer line of the paper.
void compare_rays(const RecoveredRoom& room, double reach, const TextbookCaster& textbook,
                  const OctomapCaster& octomap, const OpenvdbCaster& openvdb) {
  const std::string size = size_name(room.voxel_size_m());
  Agreement with_textbook("view_evaluation/" + size + " textbook = plain");
  Agreement with_octomap("view_evaluation/" + size + " octomap = plain");
  Agreement octomap_with_textbook("view_evaluation/" + size + " octomap = textbook");
  Agreement openvdb_with_textbook("view_evaluation/" + size + " openvdb = textbook");
  const auto rays = world_rays(RecoveredRoom::raster(), icosahedron_orientations());
  for (std::size_t i = 0; i < room.positions().size(); i += 6) {
    const VoxelIndex& sensor = room.positions()[i];
    for (const Eigen::Vector3d& ray : rays) {
      const Meeting plain = plain_cast(room.map(), sensor, ray, reach);
      const Meeting by_textbook = textbook.cast(sensor, ray);
      const Meeting by_octomap = octomap.cast(sensor, ray);
      with_textbook.compare(by_textbook == plain);
      with_octomap.compare(by_octomap == plain);
      octomap_with_textbook.compare(by_octomap == by_textbook);
      openvdb_with_textbook.compare(openvdb.cast(sensor, ray) == by_textbook);
    }
  }
  with_textbook.report("rays", "26-connected lines cut corners that 6-connected walks do not");
  with_octomap.report("rays");
  octomap_with_textbook.report("rays");
  openvdb_with_textbook.report("rays");
}

void require_same_counts(const RecoveredRoom& room, const std::string& name, ViewPredictor& fast,
                         ViewPredictor& plain) {
  Agreement same("view_evaluation/" + size_name(room.voxel_size_m()) + " " + name + " = plain");
  const KnownSpace space(room.map(), KnownSpace::Surfaces::Keep);
  std::vector<ViewCounts> of_fast(fast.orientations().size());
  std::vector<ViewCounts> of_plain(plain.orientations().size());
  for (const VoxelIndex& position : room.positions()) {
    fast.predict(space, position, of_fast);
    plain.predict(space, position, of_plain);
    for (std::size_t i = 0; i < of_fast.size(); ++i) same.compare(of_fast[i] == of_plain[i]);
  }
  same.report_and_require_none("views");
}

// How far the panorama's fitness is from the plain one, and whether it picks as good a view.
void report_panorama_error(const RecoveredRoom& room, ViewPredictor& panorama,
                           ViewPredictor& plain) {
  const KnownSpace space(room.map());
  std::vector<ViewCounts> sampled(panorama.orientations().size());
  std::vector<ViewCounts> exact(plain.orientations().size());
  double sum = 0.0;
  double largest = 0.0;
  double best_loss = 0.0;
  std::size_t compared = 0;
  for (std::size_t i = 0; i < room.positions().size(); i += 6) {
    panorama.predict(space, room.positions()[i], sampled);
    plain.predict(space, room.positions()[i], exact);
    double best = 0.0;
    std::size_t chosen = 0;
    for (std::size_t j = 0; j < exact.size(); ++j) {
      const double error = std::abs(fitness(sampled[j]).value - fitness(exact[j]).value);
      sum += error;
      largest = std::max(largest, error);
      best = std::max(best, fitness(exact[j]).value);
      if (fitness(sampled[j]).value > fitness(sampled[chosen]).value) chosen = j;
      ++compared;
    }
    best_loss = std::max(best_loss, best - fitness(exact[chosen]).value);
  }
  report_condition("fitness error view_evaluation/" + size_name(room.voxel_size_m()) +
                       " panorama, " + std::to_string(exact.size()) + " directions",
                   fmt::format("mean {:.4f}, max {:.4f} over {} views; the view chosen is at most "
                               "{:.4f} worse",
                               sum / static_cast<double>(compared), largest, compared, best_loss));
}

// The same kernel on lesser instruction sets than this processor's best.
void register_on_lesser_targets(const RecoveredRoom& room, ViewPredictor& plain, Predictor fast) {
  for (const std::int64_t target : {std::int64_t{HWY_AVX2}, std::int64_t{HWY_SSE4}}) {
    if ((hwy::SupportedTargets() & target) == 0) continue;
    const std::string name = std::string("nextview_on_") + hwy::TargetName(target);
    {
      const InstructionSets only(target);
      require_same_counts(room, name, *fast, plain);
    }
    benchmark::RegisterBenchmark(
        ("view_evaluation/" + name + "/" + size_name(room.voxel_size_m())).c_str(),
        [&room, fast, target](benchmark::State& state) {
          const InstructionSets only(target);
          const KnownSpace space(room.map(), KnownSpace::Surfaces::Keep);
          std::vector<ViewCounts> counts(fast->orientations().size());
          for (auto _ : state) {
            benchmark::DoNotOptimize(evaluate(space, *fast, room.positions(), counts));
          }
          set_rays(state, room, *fast);
        })
        ->Unit(benchmark::kMillisecond);
  }
}

void register_panorama(const RecoveredRoom& room) {
  for (const int subdivisions : {0, 2, 3}) {
    const auto orientations = icosahedron_orientations(subdivisions);
    const auto panorama = std::make_shared<PanoramaViewPredictor>(
        RecoveredRoom::raster(), room.voxel_size_m(), orientations, false);
    PlainViewPredictor plain(RecoveredRoom::raster(), room.voxel_size_m(), orientations, false);
    report_panorama_error(room, *panorama, plain);
    register_predictor("nextview_panorama_" + std::to_string(orientations.size()), room, panorama);
  }
}

}  // namespace

void register_view_evaluation(const BenchOptions& options) {
  for (const double voxel_size_m : options.voxel_sizes_m()) {
    const RecoveredRoom& room = recovered_room(voxel_size_m);
    report_condition("condition room/" + size_name(voxel_size_m), room.description());
    const PredictionRaster raster = RecoveredRoom::raster();
    const auto orientations = icosahedron_orientations();
    const double reach = prediction_reach(raster, voxel_size_m);

    static std::vector<std::shared_ptr<void>> kept;  // the casters, for as long as they are timed
    const auto textbook = std::make_shared<TextbookCaster>(room.map(), reach);
    const auto octomap = std::make_shared<OctomapCaster>(room.map(), reach);
    const auto openvdb = std::make_shared<OpenvdbCaster>(room.map(), reach);
    kept.insert(kept.end(), {textbook, octomap, openvdb});
    compare_rays(room, reach, *textbook, *octomap, *openvdb);

    for (const bool quality : {false, true}) {
      const std::string suffix = quality ? "_quality" : "";
      const auto plain =
          std::make_shared<PlainViewPredictor>(raster, voxel_size_m, orientations, quality);
      const auto fast =
          std::make_shared<FastViewPredictor>(raster, voxel_size_m, orientations, quality);
      require_same_counts(room, "nextview" + suffix, *fast, *plain);
      register_predictor("nextview" + suffix, room, fast);
      register_predictor("plain" + suffix, room, plain);
      if (!quality) register_on_lesser_targets(room, *plain, fast);
    }
    register_with_update(
        room, std::make_shared<FastViewPredictor>(raster, voxel_size_m, orientations, false));
    register_predictor(
        "nextview_2_threads", room,
        std::make_shared<FastViewPredictor>(raster, voxel_size_m, orientations, false, 2))
        ->UseRealTime();
    register_predictor(
        "textbook", room,
        std::make_shared<CastingViewPredictor<TextbookCaster>>(*textbook, raster, orientations));
    register_predictor(
        "octomap", room,
        std::make_shared<CastingViewPredictor<OctomapCaster>>(*octomap, raster, orientations));
    register_predictor(
        "openvdb", room,
        std::make_shared<CastingViewPredictor<OpenvdbCaster>>(*openvdb, raster, orientations));
    register_panorama(room);
  }
}

}  // namespace nextview
