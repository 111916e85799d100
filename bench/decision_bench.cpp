// One next best view, decided on the maps a run has after 3, 10 and 30 views, and over whole runs.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <unordered_map>

#include "bench/bench_groups.h"
#include "bench/exploration.h"
#include "bench/recovered_room.h"
#include "bench/stopwatch.h"
#include "bench/textbook_ray_walk.h"
#include "planner/prediction/fast_view_predictor.h"
#include "planner/prediction/orientations.h"
#include "planner/prediction/panorama_view_predictor.h"
#include "reports/median.h"

namespace nextview {

namespace {

// A run at one moment: its map after so many views, and where the sensor stands.
struct Moment {
  std::string name;  // boxes/10cm/view_30
  double voxel_size_m;
  int view;
  SensorPose present;  // where the last view was taken from
  std::unique_ptr<MapBuilder> builder;
  std::unique_ptr<KnownSpace> space;  // of its map
  std::unique_ptr<ClearSpace> clear;  // likewise
};

// Works out every prediction by one kernel and answers with the counts another gave, so that the
// search takes the other's way: the same decision, position for position, at this kernel's price.
class SameWay : public ViewPredictor {
 public:
  SameWay(std::shared_ptr<ViewPredictor> kernel, std::shared_ptr<ViewPredictor> leader)
      : ViewPredictor(leader->orientations(), leader->counts_surfaces()),
        kernel_(std::move(kernel)),
        leader_(std::move(leader)) {}

  // While learning, the leader predicts and its answers are kept; then the kernel works.
  void learn(bool learning) { learning_ = learning; }

  void predict(const KnownSpace& space, const VoxelIndex& sensor,
               std::span<ViewCounts> per_orientation) override {
    auto& answer = answers_[space.map().slot(sensor)];
    if (learning_) {
      answer.resize(per_orientation.size());
      leader_->predict(space, sensor, answer);
    } else {
      if (answer.empty()) throw std::logic_error("the search has left the way it learned");
      kernel_->predict(space, sensor, per_orientation);
      benchmark::DoNotOptimize(per_orientation.data());
    }
    std::copy(answer.begin(), answer.end(), per_orientation.begin());
  }

 private:
  std::shared_ptr<ViewPredictor> kernel_;
  std::shared_ptr<ViewPredictor> leader_;
  bool learning_ = true;
  std::unordered_map<std::size_t, std::vector<ViewCounts>> answers_;  // by slot
};

// What a run did, to do it again without scanning.
struct RecordedRun {
  std::vector<RangeImage> images;
  MapWindow window;
};

PredictionRaster paper_raster() {
  return prediction_raster(TiltedLineScan::paper(), RangeLimits());
}

std::shared_ptr<ViewPredictor> fast_predictor(double voxel_size_m, bool quality, int threads) {
  return std::make_shared<FastViewPredictor>(paper_raster(), voxel_size_m,
                                             icosahedron_orientations(), quality, threads);
}

std::optional<Decision> decide_after(const KnownSpace& space, const ClearSpace& clear,
                                     const SensorPose& present, int views,
                                     ViewPredictor& predictor) {
  PlannerParameters parameters;
  parameters.weights[kQualityFactor] = predictor.counts_surfaces() ? 1.0 : 0.0;
  static ShortestPaths paths;  // as a run's, keeps its memory from one decision to the next
  paths.stand_at(clear, space.map(), present.position_m, parameters.feasibility.departure_m);
  return decide_by_simplex({space, present, 1, views + 1, 1, {}}, paths, predictor, parameters);
}

std::optional<Decision> decide(const Moment& moment, ViewPredictor& predictor) {
  return decide_after(*moment.space, *moment.clear, moment.present, moment.view, predictor);
}

RecordedRun record_run(const BenchScene& scene, double voxel_size_m, int views) {
  ExplorationParameters parameters;
  parameters.voxel_size_m = voxel_size_m;
  parameters.sensor = sensor_for(voxel_size_m);
  Exploration exploration(scene, parameters);
  RecordedRun run;
  for (int view = 1; view <= views; ++view) {
    exploration.step();
    run.images.push_back(exploration.image());
  }
  run.window = exploration.builder().map().window();
  return run;
}

std::shared_ptr<Moment> moment_after(const RecordedRun& run, const std::string& scene,
                                     double voxel_size_m, int views) {
  auto moment = std::make_shared<Moment>();
  moment->name = scene + "/" + size_name(voxel_size_m) + "/view_" + std::to_string(views);
  moment->voxel_size_m = voxel_size_m;
  moment->view = views;
  moment->builder = std::make_unique<MapBuilder>(VoxelGrid{voxel_size_m}, run.window);
  for (int view = 0; view < views; ++view) {
    moment->builder->fold(run.images[static_cast<std::size_t>(view)]);
  }
  moment->space = std::make_unique<KnownSpace>(moment->builder->map(), KnownSpace::Surfaces::Keep);
  moment->clear = std::make_unique<ClearSpace>(moment->builder->map(), FeasibilityParameters());
  moment->present = run.images[static_cast<std::size_t>(views) - 1].pose;
  return moment;
}

benchmark::internal::Benchmark* register_decider(const std::string& name,
                                                 const std::shared_ptr<Moment>& moment,
                                                 const std::shared_ptr<ViewPredictor>& predictor) {
  return benchmark::RegisterBenchmark(("decision/" + name + "/" + moment->name).c_str(),
                                      [moment, predictor](benchmark::State& state) {
                                        int evaluations = 0;
                                        for (auto _ : state) {
                                          const auto decision = decide(*moment, *predictor);
                                          evaluations = decision ? decision->evaluations : 0;
                                        }
                                        state.SetItemsProcessed(state.iterations());
                                        state.counters["positions_tried"] = evaluations;
                                      })
      ->Unit(benchmark::kMillisecond);
}

void report_decisions(benchmark::State& state, const std::vector<double>& decision_s) {
  state.counters["median_ms"] = 1e3 * median(decision_s);
  state.counters["worst_ms"] = 1e3 * *std::max_element(decision_s.begin(), decision_s.end());
}

// All views of a run again, each with its fold (not timed), field update and decision (timed).
void register_run(const std::string& name, const std::string& scene, double voxel_size_m,
                  const std::shared_ptr<RecordedRun>& run, bool quality, int threads) {
  benchmark::RegisterBenchmark(
      ("decision/" + name + "/" + scene + "/" + size_name(voxel_size_m) + "/all_views").c_str(),
      [=](benchmark::State& state) {
        std::vector<double> decision_s;
        for (auto _ : state) {
          ExplorationParameters parameters;
          parameters.voxel_size_m = voxel_size_m;
          parameters.planner.weights[kQualityFactor] = quality ? 1.0 : 0.0;
          ViewPlanner planner(
              {voxel_size_m}, run->window, paper_strategy(parameters, threads),
              {.max_views = static_cast<int>(run->images.size()) + 1, .threads = threads});
          double sum_s = 0.0;
          for (const RangeImage& image : run->images) {
            planner.fold(image);
            const auto decide_now = [&] { benchmark::DoNotOptimize(planner.next_view()); };
            decision_s.push_back(threads == 1 ? thread_s(decide_now) : wall_s(decide_now));
            sum_s += decision_s.back();
          }
          state.SetIterationTime(sum_s);
        }
        state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(run->images.size()));
        report_decisions(state, decision_s);
      })
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
}

// The same decisions, view after view, at the textbook kernel's price. Its copy of the map is made
// before each decision and not timed.
void register_textbook_run(const std::string& scene, double voxel_size_m,
                           const std::shared_ptr<RecordedRun>& run) {
  benchmark::RegisterBenchmark(
      ("decision/textbook/" + scene + "/" + size_name(voxel_size_m) + "/all_views").c_str(),
      [=](benchmark::State& state) {
        std::vector<double> decision_s;
        for (auto _ : state) {
          MapBuilder builder({voxel_size_m}, run->window);
          KnownSpace space(builder.map());
          const auto leader = fast_predictor(voxel_size_m, false, 1);
          double sum_s = 0.0;
          for (std::size_t i = 0; i < run->images.size(); ++i) {
            const FoldReport& report = builder.fold(run->images[i]);
            space.update(report.changed_slots, report.updated_surfaces);
            const ClearSpace clear(builder.map(), FeasibilityParameters());
            const TextbookCaster caster(builder.map(),
                                        prediction_reach(paper_raster(), voxel_size_m));
            SameWay same_way(std::make_shared<CastingViewPredictor<TextbookCaster>>(
                                 caster, paper_raster(), icosahedron_orientations()),
                             leader);
            const auto decide_now = [&] {
              benchmark::DoNotOptimize(decide_after(space, clear, run->images[i].pose,
                                                    static_cast<int>(i) + 1, same_way));
            };
            decide_now();
            same_way.learn(false);
            decision_s.push_back(thread_s(decide_now));
            sum_s += decision_s.back();
          }
          state.SetIterationTime(sum_s);
        }
        state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(run->images.size()));
        report_decisions(state, decision_s);
      })
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
}

bool same_decision(const std::optional<Decision>& a, const std::optional<Decision>& b) {
  if (!a || !b) return !a && !b;
  return a->pose.position_m == b->pose.position_m && a->pose.pan_rad == b->pose.pan_rad &&
         a->pose.tilt_rad == b->pose.tilt_rad && a->fitness.value == b->fitness.value &&
         a->evaluations == b->evaluations;
}

// In a space that has followed the map from the first view on, the fast predictor must decide like
// the plain one in a space that is derived anew.
void compare_followed_map(const RecordedRun& run, double voxel_size_m, bool quality,
                          Agreement& with_plain) {
  constexpr std::size_t kViews = 12;
  MapBuilder builder({voxel_size_m}, run.window);
  KnownSpace followed(builder.map(), KnownSpace::Surfaces::Keep);
  const auto fast = fast_predictor(voxel_size_m, quality, 1);
  PlainViewPredictor plain(paper_raster(), voxel_size_m, icosahedron_orientations(), quality);
  for (std::size_t i = 0; i < kViews; ++i) {
    const FoldReport& report = builder.fold(run.images[i]);
    followed.update(report.changed_slots, report.updated_surfaces);
    const ClearSpace clear(builder.map(), FeasibilityParameters());
    const KnownSpace fresh(builder.map(), KnownSpace::Surfaces::Keep);
    const int views = static_cast<int>(i) + 1;
    with_plain.compare(
        same_decision(decide_after(followed, clear, run.images[i].pose, views, *fast),
                      decide_after(fresh, clear, run.images[i].pose, views, plain)));
  }
}

void register_moment(const std::shared_ptr<Moment>& moment, Agreement& with_plain) {
  const double voxel_size_m = moment->voxel_size_m;
  for (const bool quality : {false, true}) {
    const auto one = fast_predictor(voxel_size_m, quality, 1);
    const auto two = fast_predictor(voxel_size_m, quality, 2);
    PlainViewPredictor plain(paper_raster(), voxel_size_m, icosahedron_orientations(), quality);
    const auto decision = decide(*moment, plain);
    with_plain.compare(same_decision(decide(*moment, *one), decision));
    with_plain.compare(same_decision(decide(*moment, *two), decision));
    const std::string suffix = quality ? "_quality" : "";
    register_decider("nextview" + suffix, moment, one);
    register_decider("nextview" + suffix + "_2_threads", moment, two)->UseRealTime();
  }
  static std::vector<std::shared_ptr<TextbookCaster>> kept;
  kept.push_back(std::make_shared<TextbookCaster>(moment->builder->map(),
                                                  prediction_reach(paper_raster(), voxel_size_m)));
  const auto textbook = std::make_shared<CastingViewPredictor<TextbookCaster>>(
      *kept.back(), paper_raster(), icosahedron_orientations());
  const auto same_way = std::make_shared<SameWay>(textbook, fast_predictor(voxel_size_m, false, 1));
  const auto learned = decide(*moment, *same_way);
  same_way->learn(false);
  with_plain.compare(same_decision(decide(*moment, *same_way), learned));
  register_decider("textbook", moment, same_way);
  // Left to its own counts it may try other positions, and more or fewer of them.
  register_decider("textbook_its_own_way", moment, textbook);
  register_decider("nextview_panorama_1280", moment,
                   std::make_shared<PanoramaViewPredictor>(paper_raster(), voxel_size_m,
                                                           icosahedron_orientations(3), false));
}

}  // namespace

void register_decision(const BenchOptions& options) {
  const int views = options.quick ? 30 : 60;
  for (const std::string name : {"boxes", "columns"}) {
    const BenchScene scene = load_bench_scene(name);
    for (const double voxel_size_m : {0.10, 0.05}) {
      const auto run = std::make_shared<RecordedRun>(record_run(scene, voxel_size_m, views));
      Agreement with_plain("decision/" + name + "/" + size_name(voxel_size_m) +
                           " nextview = plain");
      for (const bool quality : {false, true}) {
        compare_followed_map(*run, voxel_size_m, quality, with_plain);
      }
      for (const int after : {3, 10, 30}) {
        register_moment(moment_after(*run, name, voxel_size_m, after), with_plain);
      }
      with_plain.report_and_require_none("decisions");
      register_run("nextview", name, voxel_size_m, run, false, 1);
      if (voxel_size_m >= 0.10) register_textbook_run(name, voxel_size_m, run);
      register_run("nextview_2_threads", name, voxel_size_m, run, false, 2);
      register_run("nextview_quality", name, voxel_size_m, run, true, 1);
    }
  }
}

}  // namespace nextview
