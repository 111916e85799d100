#include "runner/run_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <set>

#include "lcmtypes/parameter_bounds.h"
#include "lcmtypes/program_version.h"
#include "planner/strategy_facts.h"
#include "runner/bound_command.h"
#include "runner/nearest_option.h"
#include "runner/scene_file.h"
#include "scene/mesh_file.h"

namespace nextview {
namespace {

/// Accepts what a parameter may be; CLI::Range would let NaN through.
CLI::Validator number_within(const Bounds& bounds) {
  return CLI::Validator(
      [bounds](std::string& given) {
        double value = 0.0;
        if (!CLI::detail::lexical_cast(given, value) || !bounds.contain(value)) {
          return "must be a number " + bounds.range() + ", not " + given;
        }
        return std::string();
      },
      "");
}

/// "paper: this; surface: that", for a help text.
template <class Words>
std::string of_strategies(Words words) {
  std::string all;
  for (const StrategyFacts& strategy : all_strategies()) {
    all += fmt::format("{}{}: {}", all.empty() ? "" : "; ", strategy.name, words(strategy));
  }
  return all;
}

CLI::Validator one_of_the_strategies() {
  return CLI::Validator(
      [](std::string& given) {
        return find_strategy(given) == nullptr ? no_such_strategy(given) : std::string();
      },
      "");
}

/// --start auto, or --start X Y Z.
void take_start(const std::vector<std::string>& given, RunOptions& options) {
  options.start_auto = given.size() == 1 && given.front() == "auto";
  options.start_m.clear();
  if (options.start_auto) return;
  for (const std::string& text : given) {
    double value = 0.0;
    if (given.size() != 3 || !CLI::detail::lexical_cast(text, value) ||
        !bounds::kPosition.contain(value)) {
      throw CLI::ValidationError(
          "--start", "must be auto, or three numbers X Y Z in metres; SCENE goes before it");
    }
    options.start_m.push_back(value);
  }
}

void add_scene_options(CLI::App& app, RunOptions& options) {
  const std::string group = "Scene";
  app.add_option("SCENE", options.scene,
                 "boxes, columns, another folder of scenes/, a CAD file of any format assimp reads "
                 "(with --start, see there), or a scene file NAME.toml that holds the CAD file's "
                 "name and options; default: boxes");
  app.add_option_function<std::vector<std::string>>(
         "--start", [&options](const auto& given) { take_start(given, options); },
         "Where the sensor starts: X Y Z in metres, world frame, that of the CAD file even where "
         "it "
         "lies far from its origin; or auto: where it sees most; default: as the scene says")
      ->expected(1, 3)
      ->type_name("X Y Z | auto")
      ->group(group);
  app.add_option("--start-pan", options.start_pan_deg,
                 "Where it looks at first, degrees: 0 along +y, 90 along -x; default: as the scene "
                 "says")
      ->check(number_within(bounds::kPan.in_degrees()))
      ->group(group);
  app.add_option("--start-tilt", options.start_tilt_deg, "Its elevation at first, degrees")
      ->check(number_within(bounds::kTilt.in_degrees()))
      ->capture_default_str()
      ->group(group);
  app.add_option("--unit", options.unit,
                 "Length of one unit of the CAD file: m, cm, mm, in, ft or metres; default: as the "
                 "file says, else m")
      ->group(group);
  app.add_option("--up", options.up,
                 "The CAD file's axis that points up: x, y or z; default: as the file says, else z")
      ->group(group);
  app.add_option(
         "--without", options.without,
         "Do not start these: sensor_sim, base_sim, or both, separated by a comma; a driver "
         "of your own answers in their place. Without both there is no SCENE, and --start and "
         "--workspace say what it would have said")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"sensor_sim", "base_sim"}))
      ->group(group);
  app.add_option(
         "--elsewhere", options.elsewhere,
         "Do not start these but wait for them: sensor_sim, base_sim, mapper, separated by commas. "
         "They are started by hand, on other hosts say, by the commands that are printed; for "
         "other "
         "hosts --lcm-url has to have a ttl of at least 1")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"sensor_sim", "base_sim", "mapper"}))
      ->group(group);
  app.add_option(
         "--planner", options.planner,
         "A planner of your own: this program is started in place of nextview_planner, with "
         "--lcm-url=URL --run=N, once the others are ready")
      ->check(CLI::ExistingFile)
      ->group(group);
  app.add_option("--workspace", options.workspace_m,
                 "Without a scene: X0 Y0 Z0 X1 Y1 Z1, the box to be recovered, in metres")
      ->expected(6)
      ->check(number_within(bounds::kWorkspace))
      ->group(group);
  app.add_option("--scenes", options.scenes_folder, "Folder of the scenes known by name")
      ->capture_default_str()
      ->group(group);
}

void add_run_options(CLI::App& app, RunOptions& options) {
  const std::string group = "Run";
  app.add_option("--seed", options.seed, "The same seed gives the same run")
      ->capture_default_str()
      ->group(group);
  app.add_option("--views", options.views,
                 "End after this many views; default: " + of_strategies([](const auto& strategy) {
                   if (strategy.views == strategy.views_with_quality) {
                     return fmt::format("{}", strategy.views);
                   }
                   return fmt::format("{} (with --quality {})", strategy.views,
                                      strategy.views_with_quality);
                 }))
      ->check(number_within(bounds::kMaxViews))
      ->group(group);
  app.add_flag("--quality", options.quality,
               "Look for quality too (paper eq. 4) and go on until every voxel has it")
      ->group(group);
  app.add_option("--resume", options.resume,
                 "Go on with the run in this folder, which was killed or interrupted. Its "
                 "configuration is in its log; only options that are not part of it may be given")
      ->type_name("DIR")
      ->group(group);
  app.add_option("--out", options.out,
                 "Folder for run.lcmlog, views.csv and summary.json; default "
                 "runs/SCENE-seedN-DATE")
      ->group(group);
  app.add_option("--runs", options.runs_folder, "Folder in which that default folder is made")
      ->capture_default_str()
      ->group(group);
  app.add_option("--lcm-url", options.lcm_url,
                 "LCM URL to meet on; default: LCM_DEFAULT_URL, else a free port of the run's own")
      ->group(group);
  app.add_option("--patience", options.patience_s,
                 "Seconds without anything happening after which the run gives up")
      ->check(number_within(bounds::kPatience))
      ->capture_default_str()
      ->group(group);
  app.add_flag("--real-time{1}", options.real_time,
               "For watching: motions and scans take the time they simulate, see --base-speed, "
               "--turn-speed, --scan-duration; --real-time=8 eight times as fast. The run is the "
               "same")
      ->check(number_within(bounds::kRealTime))
      ->group(group);
  app.add_flag("--view", options.view,
               "Show the run in a browser, at the address it prints, until Ctrl-C")
      ->group(group);
  app.add_flag("--paused", options.paused,
               "With --view: begin when the page says so, with a step or to go on")
      ->group(group);
  app.add_option("--cache", options.cache,
                 "Folder that keeps what can be seen of a scene, which takes minutes in a large "
                 "building; default: NEXTVIEW_CACHE, else XDG_CACHE_HOME/nextview, else "
                 "~/.cache/nextview")
      ->group(group);
  app.add_option("--bound-spacing", options.bound_spacing_m,
                 "Spacing of the positions that nextview_bound looks at, m")
      ->check(number_within(bounds::kBoundSpacing))
      ->capture_default_str()
      ->group(group);
  app.add_flag("--no-coverage", options.no_coverage, "Do not work out surface_coverage")
      ->group(group);
  app.add_flag("--verbose", options.verbose, "Say more: port, processes, counters, timings")
      ->group(group);
}

void add_sensor_options(CLI::App& app, RunOptions& options) {
  const std::string group = "Sensor";
  SensorOptions& given = options.given_of_sensor;
  app.add_option("--sensor", options.sensor,
                 "paper, panorama, line_striper, another name in --sensors, or a file as those "
                 "there; what follows goes before what it says")
      ->capture_default_str()
      ->group(group);
  app.add_option("--sensors", options.sensors_folder, "Folder of the sensors known by name")
      ->capture_default_str()
      ->group(group);
  app.add_option("--columns", given.columns, "Columns of a range image")
      ->check(number_within(bounds::kColumns))
      ->group(group);
  app.add_option("--rows", given.rows, "Rows of a range image")
      ->check(number_within(bounds::kRows))
      ->group(group);
  app.add_option("--aperture", options.aperture_deg,
                 "Horizontal aperture, degrees; a tilted line scan's vertical one follows from it")
      ->check(number_within(bounds::kTurnAperture.in_degrees()))
      ->group(group);
  app.add_option("--range-min", given.range_min_m, "Nearer surfaces give no valid range, m")
      ->check(number_within(bounds::kRangeMin))
      ->group(group);
  app.add_option("--range-max", given.range_max_m, "Farther surfaces give no return, m")
      ->check(number_within(bounds::kRangeMax))
      ->group(group);
  app.add_option("--range-noise-m", given.range_noise_m,
                 "Standard deviation of Gaussian range noise, m")
      ->check(number_within(bounds::kRangeNoise))
      ->group(group);
  app.add_option("--scan-duration", given.scan_duration_s, "Simulated time a scan takes, s")
      ->check(number_within(bounds::kScanDuration))
      ->group(group);
}

void add_base_options(CLI::App& app, RunOptions& options) {
  const std::string group = "Base (simulated time)";
  app.add_option("--body-radius", options.body_radius_m,
                 "The body is a sphere of this radius about the sensor, m")
      ->check(number_within(bounds::kBodyRadius))
      ->capture_default_str()
      ->group(group);
  app.add_option("--lift-min", options.lift_min_m,
                 "Lowest z of the sensor, m; default: the floor under the start + body radius")
      ->check(number_within(bounds::kLift))
      ->group(group);
  app.add_option(
         "--lift-max", options.lift_max_m,
         "Highest z of the sensor, m; default: 2.8 m above the floor under the start, at most "
         "the scene's highest - body radius; more for several storeys")
      ->check(number_within(bounds::kLift))
      ->group(group);
  app.add_option("--base-speed", options.base_speed_m_s, "m/s")
      ->check(number_within(bounds::kBaseSpeed))
      ->capture_default_str()
      ->group(group);
  app.add_option("--lift-speed", options.lift_speed_m_s, "m/s")
      ->check(number_within(bounds::kLiftSpeed))
      ->capture_default_str()
      ->group(group);
  app.add_option("--turn-speed", options.turn_speed_deg_s, "Of pan and of tilt, degrees/s")
      ->check(number_within(bounds::kTurnSpeed.in_degrees()))
      ->capture_default_str()
      ->group(group);
}

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

std::vector<std::string> stop_rule_names() {
  std::vector<std::string> names;
  for (const StopRule rule : all_stop_rules()) names.emplace_back(to_string(rule));
  return names;
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

/// What may be said beside --resume, and is not in the log.
/// @throws CLI::ValidationError naming an option that is
void check_resume(const CLI::App& app, RunOptions& options) {
  if (options.resume.empty()) return;
  const std::set<std::string> free = {"--resume",  "--without",   "--elsewhere", "--planner",
                                      "--lcm-url", "--patience",  "--cache",     "--no-coverage",
                                      "--verbose", "--real-time", "--view",      "--paused",
                                      "--window"};
  for (const CLI::Option* option : app.get_options()) {
    if (option->count() == 0 || free.contains(option->get_name())) continue;
    throw CLI::ValidationError(
        "--resume", "leave out " + option->get_name() + ": the run's configuration is in its log");
  }
}

/// A folder of data: of an installation, beside its bin; else of the sources.
std::string data_folder(const std::string& name, const char* of_sources) {
  namespace fs = std::filesystem;
  const fs::path bin = fs::read_symlink("/proc/self/exe").parent_path();
  const fs::path installed = bin.parent_path() / NEXTVIEW_DATA_FOLDER / name;
  return fs::is_directory(installed) ? installed.string() : of_sources;
}

// What CLI11 says of a wrong command line, and which options may have been meant.
std::string what_is_wrong(const CLI::App* app, const CLI::Error& error) {
  std::string text = CLI::FailureMessage::simple(app, error);
  for (const std::string& typed : app->remaining()) {
    if (!typed.starts_with("--")) continue;
    const std::string name = typed.substr(2, typed.find('=') - 2);
    text += fmt::format("No option --{}; did you mean --{}?\n", name,
                        nearest_option(*app, name, "help"));
  }
  return text;
}

}  // namespace

const char* const kRunDescription =
    "Recovers a scene by itself: scans it from the start, then again and again from the next\n"
    "best view, until there is nothing left to see. Starts sensor_sim, base_sim, mapper, planner\n"
    "and lcm-logger on a bus of their own, watches them, scores what they do against the CAD\n"
    "model, and leaves run.lcmlog, views.csv and summary.json.\n";

std::optional<RunOptions> parse_run_options(int argc, char** argv, int& exit_status,
                                            const std::string& description) {
  RunOptions options;
  options.scenes_folder = data_folder("scenes", NEXTVIEW_SCENES_FOLDER);
  options.sensors_folder = data_folder("sensors", NEXTVIEW_SENSORS_FOLDER);
  CLI::App app{description};
  app.footer(
      "Examples:\n"
      "  ./run                                  the paper's first room, until nothing is left\n"
      "  ./run columns --seed 3 --quality       the second one, for quality\n"
      "  ./run --strategy paper                 the paper's method, 60 views\n"
      "  ./run flat.dae --start 1.0 2.5 1.2     a CAD model of yours\n"
      "  ./run --view                           watched in a browser\n"
      "  ./run --without sensor_sim,base_sim --start 1 2 1.2 --workspace 0 0 0 8 6 3\n"
      "                                         a robot of yours, see README\n"
      "  ./run --resume runs/boxes-seed1-DATE   goes on with a run that was killed\n"
      "  ./run hall.stl --unit cm --up y --start 4 4 1.5 --voxel-size 0.05\n\n"
      "Exit status: 0 the stop rule or the number of views was reached; 1 the run could not\n"
      "start; 3 no feasible goal; 4 mapper and planner hold different maps; 5 somebody did not\n"
      "answer; 6 a process died; 7 the bus broke down; 130, 143 or 129 ended by SIGINT, SIGTERM\n"
      "or SIGHUP, the log being readable; above 100 otherwise: a wrong command line.");
  const std::string program = std::filesystem::path(argv[0]).filename();
  app.set_version_flag("--version", program + " " + std::string(program_version()));
  app.get_formatter()->column_width(30);
  app.failure_message(what_is_wrong);
  add_scene_options(app, options);
  add_run_options(app, options);
  add_sensor_options(app, options);
  add_base_options(app, options);
  add_map_options(app, options);
  add_planner_options(app, options);
  try {
    app.parse(argc, argv);
    const std::filesystem::path scene = options.scene.value_or("");
    if (scene.extension() == ".toml") apply_scene_file(scene, app);
    if (options.paused && !options.view) {
      throw CLI::ValidationError("--paused", "needs --view, whose page lets the run go on");
    }
    check_resume(app, options);
  } catch (const CLI::ParseError& error) {
    exit_status = app.exit(error);
    return std::nullopt;
  } catch (const SceneError& error) {
    std::cerr << program << ": " << error.what() << std::endl;
    exit_status = 1;
    return std::nullopt;
  }
  if (options.resume.empty()) options.bound_command = bound_command_for(argc, argv);
  return options;
}

}  // namespace nextview
