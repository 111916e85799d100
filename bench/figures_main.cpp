// What whole runs come to, seed after seed, in one process and without the bus: the views and
// metres to 90, 95, 97, 98 and 99 % coverage, how a run ends, and how long its decisions take.
// Takes the options of ./run, and decides, moves and scans as one does.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "base_sim/base.h"
#include "base_sim/base_sim_process.h"
#include "bench/stopwatch.h"
#include "lcmtypes/standard_output.h"
#include "lcmtypes/tell_version.h"
#include "planner/planner_config.h"
#include "reports/median.h"
#include "runner/run_options.h"
#include "runner/run_setup.h"
#include "scoring/kept_file.h"
#include "scoring/surface_coverage.h"
#include "sensor/sensor_config.h"
#include "sensor_sim/scan.h"

namespace nextview {

namespace {

constexpr const char* kDescription =
    "nextview_bench_figures FIRST_SEED LAST_SEED [options of ./run]: what the runs of these seeds "
    "come to.\n";

// Where a run first had so much; nothing when it never did.
struct Reached {
  int views = 0;
  double path_m = 0.0;
};
using MayBeReached = std::optional<Reached>;

struct Figures {
  MayBeReached coverage_90, coverage_95, coverage_97, coverage_98, coverage_99;
  MayBeReached quality_90;  // mean quality 0.9
  Reached end;
  double coverage = 0.0;
  double quality = 0.0;
  int refused = 0;
  std::vector<double> decision_ms;  // of the thread's own clock
  std::string ending;
  std::string digest;
};

struct World {
  const Scene& scene;
  const VisibleSurface& visible;
  const RayTable& rays;
};

Figures run(const run_config_t& config, const World& world) {
  Figures figures;
  const std::unique_ptr<ViewPlanner> planner = make_view_planner(config);
  Base base(base_limits_of(config), start_pose_of(config), world.scene);
  SurfaceCoverage coverage;
  coverage.set_visible(planner->map(), world.visible);
  const auto decide = [&] {
    const NextView* next = nullptr;
    figures.decision_ms.push_back(1e3 * thread_s([&] {
                                    planner->space();
                                    next = &planner->next_view();
                                  }));
    return next;
  };
  for (;;) {
    const int view = planner->views() + 1;
    RandomStream noise(config.seed, view, planner->attempt(), RandomPurpose::RangeNoise);
    coverage.add_view(planner->map(),
                      planner->fold(scan(world.scene, world.rays, range_limits_of(config),
                                         base.pose(), config.sensor.range_noise_m, noise)));
    figures.end.views = view;
    figures.coverage = coverage.after_view(view).value_or(0.0);
    figures.quality = planner->builder().statistics().mean_quality;
    const auto note = [&](MayBeReached& reached, double value, double wanted) {
      if (!reached && value >= wanted) reached = figures.end;
    };
    note(figures.coverage_90, figures.coverage, 0.90);
    note(figures.coverage_95, figures.coverage, 0.95);
    note(figures.coverage_97, figures.coverage, 0.97);
    note(figures.coverage_98, figures.coverage, 0.98);
    note(figures.coverage_99, figures.coverage, 0.99);
    note(figures.quality_90, figures.quality, 0.90);
    if (view % 50 == 0) {
      fmt::print(stderr, "  view {}, {:.1f} m, coverage {:.4f}\n", view, figures.end.path_m,
                 figures.coverage);
    }
    for (const NextView* next = decide();; next = decide()) {
      if (const Ending* ending = std::get_if<Ending>(next)) {
        figures.ending = ending->detail;
        figures.digest = planner->builder().digest();
        return figures;
      }
      const Decision& decision = std::get<Decision>(*next);
      const Motion motion = base.move(decision.waypoints_m, decision.pose);
      if (motion.arrived) {
        figures.end.path_m += motion.path_length_m;
        break;
      }
      ++figures.refused;
      fmt::print(stderr, "  view {} refused: {}\n", view + 1, motion.refusal);
      if (planner->attempt() >= config.planner.max_attempts) {
        figures.ending = "too many attempts were refused";
        figures.digest = planner->builder().digest();
        return figures;
      }
      planner->refuse();
    }
  }
}

std::string in_words(const MayBeReached& reached) {
  if (!reached) return "     never      ";
  return fmt::format("{:6} {:7.1f}  ", reached->views, reached->path_m);
}

void print_heading() {
  fmt::print("{:>5} {:>16}{:>16}{:>16}{:>16}{:>16}{:>16}{:>16} {:>8} {:>8} {:>7} {:>7} {:>7}\n",
             "seed", "90 %: views, m", "95 %", "97 %", "98 %", "99 %", "quality 0.9", "end",
             "coverage", "quality", "refused", "ms", "worst");
}

void print(std::int64_t seed, const Figures& figures) {
  const double worst = *std::max_element(figures.decision_ms.begin(), figures.decision_ms.end());
  fmt::print("{:5} {}{}{}{}{}{}{} {:8.4f} {:8.4f} {:7} {:7.1f} {:7.1f}  {}  {}\n", seed,
             in_words(figures.coverage_90), in_words(figures.coverage_95),
             in_words(figures.coverage_97), in_words(figures.coverage_98),
             in_words(figures.coverage_99), in_words(figures.quality_90), in_words(figures.end),
             figures.coverage, figures.quality, figures.refused, median(figures.decision_ms), worst,
             figures.digest, figures.ending);
  std::fflush(stdout);
}

// The mean over all runs; how many did not get there, if any.
std::string mean_in_words(const std::vector<Figures>& runs, MayBeReached Figures::*reached) {
  double views = 0.0;
  double path_m = 0.0;
  int missed = 0;
  for (const Figures& run : runs) {
    const Reached at = (run.*reached).value_or(Reached{});
    views += at.views;
    path_m += at.path_m;
    missed += run.*reached ? 0 : 1;
  }
  const auto count = static_cast<double>(runs.size());
  return missed == 0 ? fmt::format("{:6.2f} {:7.2f}  ", views / count, path_m / count)
                     : fmt::format("{:4} x never    ", missed);
}

void print_mean(const std::vector<Figures>& runs) {
  const auto mean = [&](auto of) {
    double sum = 0.0;
    for (const Figures& run : runs) sum += of(run);
    return sum / static_cast<double>(runs.size());
  };
  std::vector<double> decision_ms;
  int refused = 0;
  for (const Figures& run : runs) {
    decision_ms.insert(decision_ms.end(), run.decision_ms.begin(), run.decision_ms.end());
    refused += run.refused;
  }
  const std::string end =
      fmt::format("{:6.2f} {:7.2f}  ", mean([](const Figures& f) { return f.end.views; }),
                  mean([](const Figures& f) { return f.end.path_m; }));
  fmt::print(" mean {}{}{}{}{}{}{} {:8.4f} {:8.4f} {:7} {:7.1f} {:7.1f}\n",
             mean_in_words(runs, &Figures::coverage_90), mean_in_words(runs, &Figures::coverage_95),
             mean_in_words(runs, &Figures::coverage_97), mean_in_words(runs, &Figures::coverage_98),
             mean_in_words(runs, &Figures::coverage_99), mean_in_words(runs, &Figures::quality_90),
             end, mean([](const Figures& f) { return f.coverage; }),
             mean([](const Figures& f) { return f.quality; }), refused, median(decision_ms),
             *std::max_element(decision_ms.begin(), decision_ms.end()));
}

void run_all(std::int64_t first_seed, std::int64_t last_seed, const RunOptions& options) {
  RunSetup setup = prepare_run(options);
  if (!setup.scene) throw SetupError("there is no scene to run in");
  const VisibleSurface visible = kept_visible_surface(
      cache_folder(options.cache), *setup.scene, std::string(setup.config.scene_digest),
      start_pose_of(setup.config).position_m, visibility_of(setup.config));
  const RayTable rays = make_ray_table(sensor_of(setup.config));
  fmt::print("{}, {:.1f} m2 can be seen\n", setup.config.scene_name, visible.area_m2());
  print_heading();
  std::vector<Figures> runs;
  for (std::int64_t seed = first_seed; seed <= last_seed; ++seed) {
    setup.config.seed = seed;
    runs.push_back(run(setup.config, {*setup.scene, visible, rays}));
    print(seed, runs.back());
  }
  print_mean(runs);
}

std::int64_t seed_of(const char* text) {
  std::int64_t seed = 0;
  const char* end = text + std::strlen(text);
  const auto [read, error] = std::from_chars(text, end, seed);
  if (error != std::errc() || read != end) {
    throw std::invalid_argument(std::string("'") + text + "' is no seed");
  }
  return seed;
}

int figures(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << kDescription;
    return 2;
  }
  const std::int64_t first_seed = seed_of(argv[1]);
  const std::int64_t last_seed = seed_of(argv[2]);
  if (last_seed < first_seed) throw std::invalid_argument("LAST_SEED is below FIRST_SEED");
  argv[2] = argv[0];
  int exit_status = 0;
  const auto options = parse_run_options(argc - 2, argv + 2, exit_status, kDescription);
  if (!options) return exit_status;
  run_all(first_seed, last_seed, *options);
  return EXIT_SUCCESS;
}

}  // namespace

}  // namespace nextview

int main(int argc, char** argv) {
  nextview::answer_for_standard_output();
  if (nextview::tell_version(argc, argv)) return 0;
  try {
    return nextview::figures(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "nextview_bench_figures: " << error.what() << "\n";
    return 1;
  }
}
