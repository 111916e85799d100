#include "runner/run_options.h"

#include <filesystem>
#include <iostream>
#include <set>

#include "lcmtypes/nearest_option.h"
#include "lcmtypes/parameter_bounds.h"
#include "lcmtypes/program_version.h"
#include "runner/bound_command.h"
#include "runner/option_groups.h"
#include "runner/scene_file.h"
#include "scene/mesh_file.h"

namespace nextview {
namespace {

/// What may be said beside --resume, and is not in the log.
/// @throws CLI::ValidationError naming an option that is
void check_resume(const CLI::App& app, RunOptions& options) {
  if (options.resume.empty()) return;
  const std::set<std::string> free = {"--resume",  "--without",   "--elsewhere", "--planner",
                                      "--lcm-url", "--patience",  "--cache",     "--no-coverage",
                                      "--verbose", "--real-time", "--view",      "--paused",
                                      "--window",  "--private",   "--key-file"};
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

}  // namespace

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
  app.add_flag_function(
         "--private,!--no-private",
         [&options](std::int64_t count) { options.own_network = count > 0; },
         "The processes and the recorder meet in a network of their own, into and out of which "
         "nothing goes; what joins it is printed. So they do without being told, where that is "
         "allowed and neither --lcm-url, --without nor --elsewhere expects anybody from outside")
      ->group(group);
  app.add_option("--key-file", options.key_file,
                 "Every message of the run is signed by this key, and what is not is refused: a "
                 "file of 32 random bytes or more, for nobody's eyes but yours")
      ->type_name("FILE")
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
