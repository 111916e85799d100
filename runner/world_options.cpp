// What a run goes on in: the scene, and the robot that is in it.
#include "lcmtypes/parameter_bounds.h"
#include "runner/option_groups.h"

namespace nextview {
namespace {

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

}  // namespace

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

}  // namespace nextview
