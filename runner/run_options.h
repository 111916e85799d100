#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base_sim/base.h"
#include "planner/paper_strategy.h"
#include "planner/surface_strategy.h"
#include "planner/termination.h"
#include "sensor/sensor_catalog.h"

namespace nextview {

/// What a user can say about a run, with the defaults. Angles in degrees, as typed.
struct RunOptions {
  std::optional<std::string> scene;  ///< boxes
  std::string scenes_folder;
  std::optional<std::string> unit;
  std::optional<std::string> up;
  /// Of sensor_sim and base_sim those that a driver of one's own stands in for. Without either
  /// there is no scene.
  std::vector<std::string> without;
  std::string planner;              ///< program started as the planner; empty: nextview_planner
  std::vector<double> workspace_m;  ///< without a scene: its lowest corner and its highest
  std::vector<double> start_m;      ///< three numbers, or empty: what the scene says
  bool start_auto = false;          ///< a start is to be found
  std::optional<double> start_pan_deg;
  double start_tilt_deg = 0.0;

  std::int64_t seed = 1;
  std::optional<int> views;  ///< default: as the strategy says
  bool quality = false;
  double structure_weight = kFactors[kStructureFactor].default_weight;
  double navigation_weight = kFactors[kNavigationFactor].default_weight;
  std::string resume;  ///< folder of a run to be taken up again; empty: a new run begins
  std::string out;     ///< folder of the run; empty: a new one in runs_folder
  std::string runs_folder = "runs";

  std::vector<std::string> elsewhere;  ///< roles that are started by hand, on other hosts say

  std::string sensor = "paper";  ///< a name in sensors_folder, or a file
  std::string sensors_folder;    ///< empty: those of this repository
  std::optional<double> aperture_deg;
  SensorOptions given_of_sensor;  ///< but the aperture

  double body_radius_m = BaseLimits{}.body_radius_m;
  std::optional<double> lift_min_m;
  std::optional<double> lift_max_m;
  double base_speed_m_s = BaseLimits{}.base_speed_m_s;
  double lift_speed_m_s = BaseLimits{}.lift_speed_m_s;
  double turn_speed_deg_s = 45.0;

  double voxel_size_m = 0.10;
  int margin_voxels = 1;
  std::vector<double> window_m;  ///< three sides, or empty: all of the map lies in one buffer

  double clearance_m = FeasibilityParameters{}.clearance_m;
  std::string strategy = std::string(SurfaceStrategy::kFacts.name);
  double departure_m = FeasibilityParameters{}.departure_m;
  double later_departure_m = SurfaceParameters{}.departure_m;
  double path_cost_per_m = SurfaceParameters{}.path_cost_per_m;
  double least_overlap = SurfaceParameters{}.min_overlap;
  double least_gain_m2 = SurfaceParameters{}.least_new_area_m2;
  bool return_home = false;
  std::optional<int> directions;  ///< default: as the strategy says
  std::string prediction_rays;    ///< COLUMNSxROWS; empty: the planner chooses
  int threads = 1;
  double step_min_m = PlannerParameters{}.step_min_m;
  double step_max_m = PlannerParameters{}.step_max_m;
  double fitness_tolerance = PlannerParameters{}.fitness_tolerance;
  int max_evaluations = PlannerParameters{}.max_evaluations;
  int max_attempts = 5;
  std::string stop_rule;  ///< empty: nothing_new, with quality the rule quality
  double quality_threshold = StopParameters{}.quality_threshold;
  int stop_window_views = StopParameters{}.stop_window_views;
  double stop_new_area_m2 = StopParameters{}.stop_new_area_m2;

  std::string lcm_url;  ///< empty: LCM_DEFAULT_URL, else a free port of its own
  /// The processes meet in a network that nobody else is in. Nothing: where there can be one, and
  /// nobody is expected from outside.
  std::optional<bool> own_network;
  std::string key_file;  ///< by which messages are signed; empty: they are not
  double patience_s = 60.0;
  double real_time = 0.0;  ///< simulated seconds a second, for watching; 0: as fast as it goes
  std::string cache;       ///< where results that take long are kept; empty: see cache_folder
  double bound_spacing_m = 0.40;  ///< of the positions nextview_bound looks at
  bool no_coverage = false;       ///< surface_coverage is not worked out
  bool verbose = false;
  bool view = false;    ///< shown in a browser while it goes on
  bool paused = false;  ///< with view: goes no further than the page says

  std::string bound_command;  ///< for a shell: works out the bounds for what has been typed
};

/// Reads the command line.
/// @return the options; or, when the program has nothing more to do (--help, or a line that cannot
///         be right, which has been printed), its exit status in `exit_status`
/// @param description what --help says first
std::optional<RunOptions> parse_run_options(int argc, char** argv, int& exit_status,
                                            const std::string& description);
/// Of ./run.
extern const char* const kRunDescription;

}  // namespace nextview
