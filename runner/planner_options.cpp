// What a run makes of what it senses: the map, and the planner's next views.
#include <fmt/ranges.h>

#include "lcmtypes/parameter_bounds.h"
#include "runner/option_groups.h"

namespace nextview {
namespace {

CLI::Validator one_of_the_strategies() {
  return CLI::Validator(
      [](std::string& given) {
        return find_strategy(given) == nullptr ? no_such_strategy(given) : std::string();
      },
      "");
}

std::vector<std::string> stop_rule_names() {
  std::vector<std::string> names;
  for (const StopRule rule : all_stop_rules()) names.emplace_back(to_string(rule));
  return names;
}

}  // namespace

void add_map_options(CLI::App& app, RunOptions& options) {
  const std::string group = "Voxel map";
  app.add_option("--voxel-size", options.voxel_size_m, "Side of a voxel, m")
      ->check(number_within(bounds::kVoxelSize))
      ->capture_default_str()
      ->group(group);
  app.add_option("--margin-voxels", options.margin_voxels,
                 "Voxels the map reaches beyond the scene on every side")
      ->check(number_within(bounds::kMarginVoxels))
      ->capture_default_str()
      ->group(group);
  app.add_option(
         "--window", options.window_m,
         "X Y Z, m: how much of the map the mapper has open in memory about the sensor; the "
         "rest of what was seen is kept aside, packed. Default: all of it. The result does "
         "not depend on it")
      ->expected(3)
      ->check(number_within(bounds::kWindow))
      ->group(group);
}

void add_planner_options(CLI::App& app, RunOptions& options) {
  const std::string group = "Planner";
  app.add_option("--strategy", options.strategy,
                 "How views are chosen: " + of_strategies([](const auto& strategy) {
                   return std::string(strategy.summary);
                 }))
      ->check(one_of_the_strategies())
      ->capture_default_str()
      ->group(group);
  app.add_option("--path-cost", options.path_cost_per_m,
                 "surface, paper_tidy_up: trades views against metres; a way of d metres makes a "
                 "view worth exp(-COST d) of what it shows, 0: fewest views")
      ->check(number_within(bounds::kPathCost))
      ->capture_default_str()
      ->group(group);
  app.add_option("--least-overlap", options.least_overlap,
                 "surface: share of a view that must be known already, for registration")
      ->check(number_within(bounds::kLeastOverlap))
      ->capture_default_str()
      ->group(group);
  app.add_option("--least-gain", options.least_gain_m2,
                 "surface: the run ends when no view is expected to show more new surface, m2")
      ->check(number_within(bounds::kLeastGain))
      ->capture_default_str()
      ->group(group);
  app.add_flag("--return", options.return_home, "surface: come home when nothing is left")
      ->group(group);
  app.add_option("--clearance", options.clearance_m,
                 "Nothing known may be nearer to the sensor and its path, m (paper: 4 voxels)")
      ->check(number_within(bounds::kClearance))
      ->capture_default_str()
      ->group(group);
  app.add_option("--departure", options.departure_m,
                 "Unknown space this near to where the sensor stands does not hold it back, m")
      ->check(number_within(bounds::kDeparture))
      ->capture_default_str()
      ->group(group);
  app.add_option(
         "--later-departure", options.later_departure_m,
         "Likewise after the first move, m: surface, tidying up, and more directions than 20")
      ->check(number_within(bounds::kDeparture))
      ->capture_default_str()
      ->group(group);
  app.add_option(
         "--directions", options.directions,
         fmt::format("Orientations a view is chosen among at every position, one of {}; default: ",
                     fmt::join(bounds::kDirections, ", ")) +
             of_strategies(
                 [](const auto& strategy) { return std::to_string(strategy.directions); }))
      ->check(
          CLI::IsMember(std::vector<int>(bounds::kDirections.begin(), bounds::kDirections.end())))
      ->group(group);
  app.add_option("--prediction-rays", options.prediction_rays,
                 "COLUMNSxROWS: the rays a view is predicted with, at most; default 64x32")
      ->group(group);
  app.add_option("--threads", options.threads,
                 "Threads the planner may use; the result does not depend on it")
      ->check(number_within(bounds::kThreads))
      ->capture_default_str()
      ->group(group);
  app.add_option("--step-min", options.step_min_m,
                 "Least distance of the first simplex's vertices from the sensor, m")
      ->check(number_within(bounds::kStep))
      ->capture_default_str()
      ->group(group);
  app.add_option("--step-max", options.step_max_m, "Largest such distance, m")
      ->check(number_within(bounds::kStep))
      ->capture_default_str()
      ->group(group);
  app.add_option("--fitness-tolerance", options.fitness_tolerance,
                 "The search stops when the simplex's fitness range falls below")
      ->check(number_within(bounds::kFitnessTolerance))
      ->capture_default_str()
      ->group(group);
  app.add_option("--max-evaluations", options.max_evaluations,
                 "... or after this many positions, each in all orientations")
      ->check(number_within(bounds::kMaxEvaluations))
      ->capture_default_str()
      ->group(group);
  app.add_option("--max-attempts", options.max_attempts,
                 "Goals of one view the base may refuse before the run gives up")
      ->check(number_within(bounds::kMaxAttempts))
      ->capture_default_str()
      ->group(group);
  app.add_option(
         "--stop-rule", options.stop_rule,
         "By what strategies of the paper's end: nothing_new, nothing new is covered; quality, the "
         "same, and every voxel's quality is at --quality-threshold; no_improvement, the same, and "
         "the mean quality has risen by less than 0.002; default nothing_new, with --quality "
         "quality")
      ->check(CLI::IsMember(stop_rule_names()))
      ->group(group);
  app.add_option("--structure-weight", options.structure_weight,
                 "Of the paper's fitness: what a view counts more for seeing surfaces that tell "
                 "where it was taken "
                 "from (f_structure); the paper's product has 1, 0: off")
      ->check(number_within(bounds::kFactorWeight))
      ->capture_default_str()
      ->group(group);
  app.add_option("--navigation-weight", options.navigation_weight,
                 "Of the paper's fitness: what a view counts more for being near by real paths "
                 "(f_navigation); "
                 "likewise")
      ->check(number_within(bounds::kFactorWeight))
      ->capture_default_str()
      ->group(group);
  app.add_option("--quality-threshold", options.quality_threshold,
                 "Rule quality: the quality every voxel should reach, 0 to 1")
      ->check(number_within(bounds::kQualityThreshold))
      ->capture_default_str()
      ->group(group);
  app.add_option("--stop-window", options.stop_window_views,
                 "Nothing new is covered when over this many views ...")
      ->check(number_within(bounds::kStopWindow))
      ->capture_default_str()
      ->group(group);
  app.add_option("--stop-new-area", options.stop_new_area_m2,
                 "... less than this area became newly Occupied, m2")
      ->check(number_within(bounds::kStopNewArea))
      ->capture_default_str()
      ->group(group);
}

}  // namespace nextview
