// Every bound of parameter_bounds.h against all who go by it: the options, the checks of messages
// and the libraries. Just inside all of them accept, just outside none does.
#include "lcmtypes/parameter_bounds.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "base_sim/base.h"
#include "lcmtypes/validate.h"
#include "mapper/voxel_map.h"
#include "planner/paper_strategy.h"
#include "planner/prediction/view_predictor.h"
#include "planner/surface_strategy.h"
#include "planner/termination.h"
#include "planner/view_planner.h"
#include "runner/run_options.h"
#include "runner/run_setup.h"
#include "scene/scene_options.h"
#include "scoring/pose_cover.h"
#include "sensor/sensor_geometry.h"
#include "tests/lcmtypes/examples.h"

namespace nextview {
namespace {

using SetMessage = std::function<void(run_config_t&, double)>;
using InLibrary = std::function<void(double)>;  ///< throws std::invalid_argument

/// How a bound is reached.
struct Row {
  std::string name;      ///< of the constant in parameter_bounds.h
  Bounds bounds;         ///< of what a message and a library are given
  std::string option;    ///< empty: there is none
  SetMessage message;    ///< empty: no message carries it
  InLibrary in_library;  ///< empty: no library reads it
  double typed = 1.0;    ///< of an option's unit there are so many in the message's
  /// Typed, with what must come before and after; the value where there is an @. What begins with =
  /// belongs to the word before it.
  std::vector<std::string> words = {"@"};
  bool whole = false;
  /// The option is text that only the set-up of a run reads.
  bool read_by_set_up = false;
};

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// A room that is larger than any workspace.
const Scene& large_room() {
  static const Scene scene([] {
    constexpr float kHalf_m = 9000.0F;
    TriangleMesh room;
    for (int corner = 0; corner < 8; ++corner) {
      room.vertices_m.push_back({(corner & 1) != 0 ? kHalf_m : -kHalf_m,
                                 (corner & 2) != 0 ? kHalf_m : -kHalf_m,
                                 (corner & 4) != 0 ? kHalf_m : -kHalf_m});
    }
    room.triangles = {{0, 1, 2}, {1, 2, 3}, {4, 5, 6}, {5, 6, 7}, {0, 1, 4}, {1, 4, 5},
                      {2, 3, 6}, {3, 6, 7}, {0, 2, 4}, {2, 4, 6}, {1, 3, 5}, {3, 5, 7}};
    return room;
  }());
  return scene;
}

void base_with(const std::function<void(BaseLimits&)>& change, double pan_rad = 0.0,
               double tilt_rad = 0.0) {
  BaseLimits limits;
  limits.workspace_min_m.setConstant(-8000.0);
  limits.workspace_max_m.setConstant(8000.0);
  limits.lift_min_m = -8000.0;
  limits.lift_max_m = 8000.0;
  change(limits);
  Eigen::Vector3d start_m = 0.5 * (limits.workspace_min_m + limits.workspace_max_m);
  start_m.z() = 0.5 * (limits.lift_min_m + limits.lift_max_m);
  const Base base(limits, {start_m, pan_rad, tilt_rad}, large_room());
}

void map_of(const VoxelGrid& grid, const MapWindow& window) { const VoxelMap map(grid, window); }

template <class Parameters, class Change>
void checked(Change change) {
  Parameters parameters;
  change(parameters);
  parameters.check();
}

void sensor_with(const std::function<void(SensorModel&)>& change) {
  SensorModel sensor;
  change(sensor);
  check_sensor(sensor);
}

std::vector<Row> rows() {
  using namespace bounds;
  const auto sensor = [](double sensor_config_t::*field) {
    return [field = field](run_config_t& m, double v) { m.sensor.*field = v; };
  };
  const auto base = [](double base_config_t::*field) {
    return [field = field](run_config_t& m, double v) { m.base.*field = v; };
  };
  const auto planner = [](double planner_config_t::*field) {
    return [field = field](run_config_t& m, double v) { m.planner.*field = v; };
  };
  const auto planner_int = [](std::int32_t planner_config_t::*field) {
    return [field = field](run_config_t& m, double v) {
      m.planner.*field = static_cast<std::int32_t>(v);
    };
  };
  const auto geometry = [](int kind, int parameter) {
    return [=](run_config_t& m, double v) {
      m.sensor.geometry = static_cast<std::int8_t>(kind);
      m.sensor.geometry_parameter[parameter] = v;
    };
  };
  std::vector<Row> all;
  const auto add = [&all](Row row) { all.push_back(std::move(row)); };

  add({"kUnit",
       kUnit,
       "--unit",
       [](run_config_t& m, double v) { m.scene.unit_m = v; },
       [](double v) { parse_unit_m(fmt::format("{}", v)); },
       1.0,
       {"@"},
       false,
       true});

  add({"kColumns",
       kColumns,
       "--columns",
       [](run_config_t& m, double v) { m.sensor.columns = static_cast<std::int32_t>(v); },
       [](double v) { check_sensor(with_raster(TiltedLineScan::paper(), static_cast<int>(v), 4)); },
       1.0,
       {"@"},
       true});
  add({"kRows",
       kRows,
       "--rows",
       [](run_config_t& m, double v) { m.sensor.rows = static_cast<std::int32_t>(v); },
       [](double v) { check_sensor(with_raster(TiltedLineScan::paper(), 4, static_cast<int>(v))); },
       1.0,
       {"@"},
       true});
  add({"kAperture", kAperture, "", geometry(0, 1), [](double v) {
         check_sensor(TiltedLineScan{4, 4, 1.0, v});
       }});
  add({"kTurnAperture", kTurnAperture, "--aperture", geometry(1, 0),
       [](double v) {
         check_sensor(SphericalScanner{4, 4, v, 1.0});
       },
       kDegrees});
  add({"kTiltedAperture", kTiltedAperture, "", {}, [](double v) {
         TiltedLineScan::with_aperture(4, 4, v);
       }});
  add({"kBaseline", kBaseline, "", geometry(2, 2), [](double v) {
         check_sensor(LineStriper{4, 4, 1.0, 1.0, v});
       }});
  add({"kRangeMin", kRangeMin, "--range-min",
       [](run_config_t& m, double v) {
         m.sensor.range_min_m = v;
         m.sensor.range_max_m = 1e5;
       },
       [](double v) { sensor_with([v](SensorModel& s) {
                        s.limits = {v, 1e5};
                      }); }});
  add({"kRangeMax", kRangeMax, "--range-max",
       [](run_config_t& m, double v) {
         m.sensor.range_min_m = 0.0;
         m.sensor.range_max_m = v;
       },
       [](double v) { sensor_with([v](SensorModel& s) {
                        s.limits = {0.0, v};
                      }); }});
  add({"kRangeNoise", kRangeNoise, "--range-noise-m", sensor(&sensor_config_t::range_noise_m),
       [](double v) { sensor_with([v](SensorModel& s) { s.range_noise_m = v; }); }});
  add({"kScanDuration", kScanDuration, "--scan-duration", sensor(&sensor_config_t::scan_duration_s),
       [](double v) { sensor_with([v](SensorModel& s) { s.scan_duration_s = v; }); }});

  add({"kPosition",
       kPosition,
       "--start",
       [](run_config_t& m, double v) { m.scene.origin_in_file_m[1] = v; },
       [](double v) {
         map_of({0.1, {v, 0.0, 0.0}}, MapWindow());
       },
       1.0,
       {"@", "0", "0"}});
  add({"kWorkspace",
       kWorkspace,
       "--workspace",
       [](run_config_t& m, double v) {
         (v < 0.0 ? m.base.workspace_min_m : m.base.workspace_max_m)[0] = v;
       },
       [](double v) {
         checked<FeasibilityParameters>([v](FeasibilityParameters& p) {
           (v < 0.0 ? p.workspace_min_m : p.workspace_max_m).x() = v;
         });
         base_with(
             [v](BaseLimits& l) { (v < 0.0 ? l.workspace_min_m : l.workspace_max_m).x() = v; });
       },
       1.0,
       {"@", "0", "0", "1", "1", "1"}});
  add({"kLift", kLift, "",
       [](run_config_t& m, double v) { (v < 0.0 ? m.base.lift_min_m : m.base.lift_max_m) = v; },
       [](double v) {
         checked<FeasibilityParameters>(
             [v](FeasibilityParameters& p) { (v < 0.0 ? p.lift_min_m : p.lift_max_m) = v; });
         base_with([v](BaseLimits& l) { (v < 0.0 ? l.lift_min_m : l.lift_max_m) = v; });
       }});
  all.back().option = "--lift-min";
  add(all.back());
  all.back().option = "--lift-max";
  add({"kPan", kPan, "--start-pan", base(&base_config_t::start_pan_rad),
       [](double v) { base_with([](BaseLimits&) {}, v, 0.0); }, kDegrees});
  add({"kTilt", kTilt, "--start-tilt", base(&base_config_t::start_tilt_rad),
       [](double v) { base_with([](BaseLimits&) {}, 0.0, v); }, kDegrees});
  add({"kBodyRadius", kBodyRadius, "--body-radius", base(&base_config_t::body_radius_m),
       [](double v) {
         checked<FeasibilityParameters>([v](FeasibilityParameters& p) { p.body_radius_m = v; });
         base_with([v](BaseLimits& l) { l.body_radius_m = v; });
       }});
  add({"kBaseSpeed", kBaseSpeed, "--base-speed", base(&base_config_t::base_speed_m_s),
       [](double v) { base_with([v](BaseLimits& l) { l.base_speed_m_s = v; }); }});
  add({"kLiftSpeed", kLiftSpeed, "--lift-speed", base(&base_config_t::lift_speed_m_s),
       [](double v) { base_with([v](BaseLimits& l) { l.lift_speed_m_s = v; }); }});
  add({"kTurnSpeed", kTurnSpeed, "--turn-speed", base(&base_config_t::turn_speed_rad_s),
       [](double v) { base_with([v](BaseLimits& l) { l.turn_speed_rad_s = v; }); }, kDegrees});

  add({"kVoxelSize", kVoxelSize, "--voxel-size",
       [](run_config_t& m, double v) { m.map.voxel_size_m = v; },
       [](double v) {
         map_of({v, Eigen::Vector3d::Zero()}, MapWindow());
       }});
  add({"kWindowSize",
       kWindowSize,
       "",
       [](run_config_t& m, double v) { m.map.window_size[1] = static_cast<std::int32_t>(v); },
       [](double v) {
         map_of(VoxelGrid(), {VoxelIndex::Zero(), VoxelIndex(2, static_cast<int>(v), 2)});
       },
       1.0,
       {},
       true});
  add({"kWindowMin",
       kWindowMin,
       "",
       [](run_config_t& m, double v) { m.map.window_min[1] = static_cast<std::int32_t>(v); },
       [](double v) {
         map_of(VoxelGrid(), {VoxelIndex(0, static_cast<int>(v), 0), VoxelIndex(2, 2, 2)});
       },
       1.0,
       {},
       true});

  add({"kMaxViews",
       kMaxViews,
       "--views",
       planner_int(&planner_config_t::max_views),
       [](double v) {
         checked<ViewPlanner::Parameters>([v](auto& p) { p.max_views = static_cast<int>(v); });
       },
       1.0,
       {"@"},
       true});
  add({"kMaxAttempts",
       kMaxAttempts,
       "--max-attempts",
       planner_int(&planner_config_t::max_attempts),
       {},
       1.0,
       {"@"},
       true});
  add({"kThreads",
       kThreads,
       "--threads",
       planner_int(&planner_config_t::threads),
       [](double v) {
         checked<ViewPlanner::Parameters>([v](auto& p) { p.threads = static_cast<int>(v); });
       },
       1.0,
       {"@"},
       true});
  add({"kStep", kStep, "--step-min",
       [](run_config_t& m, double v) {
         m.planner.step_min_m = v;
         m.planner.step_max_m = std::max(v, 1e5);
       },
       [](double v) {
         checked<PlannerParameters>([v](PlannerParameters& p) {
           p.step_min_m = v;
           p.step_max_m = std::max(v, 1e5);
         });
       }});
  add({"kStep", kStep, "--step-max",
       [](run_config_t& m, double v) {
         m.planner.step_min_m = std::min(v, 1e-4);
         m.planner.step_max_m = v;
       },
       [](double v) {
         checked<PlannerParameters>([v](PlannerParameters& p) {
           p.step_min_m = std::min(v, 1e-4);
           p.step_max_m = v;
         });
       }});
  add({"kFitnessTolerance", kFitnessTolerance, "--fitness-tolerance",
       planner(&planner_config_t::fitness_tolerance),
       [](double v) { checked<PlannerParameters>([v](auto& p) { p.fitness_tolerance = v; }); }});
  add({"kPredictionRays",
       kPredictionRays,
       "--prediction-rays",
       [](run_config_t& m, double v) {
         m.planner.prediction_columns = 16;
         m.planner.prediction_rows = static_cast<std::int32_t>(v);
       },
       [](double v) {
         prediction_raster(TiltedLineScan::paper(), RangeLimits(), {16, static_cast<int>(v)});
       },
       1.0,
       {"16x@"},
       true,
       true});
  add({"kMaxEvaluations",
       kMaxEvaluations,
       "--max-evaluations",
       planner_int(&planner_config_t::max_evaluations),
       [](double v) {
         checked<PlannerParameters>([v](auto& p) { p.max_evaluations = static_cast<int>(v); });
       },
       1.0,
       {"@"},
       true});
  add({"kClearance", kClearance, "--clearance", planner(&planner_config_t::clearance_m),
       [](double v) { checked<FeasibilityParameters>([v](auto& p) { p.clearance_m = v; }); }});
  add({"kDeparture", kDeparture, "--departure", planner(&planner_config_t::departure_m),
       [](double v) {
         checked<FeasibilityParameters>([v](auto& p) { p.departure_m = v; });
         checked<SurfaceParameters>([v](auto& p) { p.first_departure_m = v; });
       }});
  add({"kDeparture", kDeparture, "--later-departure", planner(&planner_config_t::later_departure_m),
       [](double v) { checked<SurfaceParameters>([v](auto& p) { p.departure_m = v; }); }});
  for (const auto& [option, field, factor] :
       {std::tuple("--structure-weight", &planner_config_t::structure_weight, kStructureFactor),
        std::tuple("--navigation-weight", &planner_config_t::navigation_weight,
                   kNavigationFactor)}) {
    add({"kFactorWeight", kFactorWeight, option,
         [field = field](run_config_t& m, double v) {
           m.strategy = PaperStrategy::kFacts.name;
           m.planner.*field = v;
         },
         [factor = factor](double v) {
           checked<PlannerParameters>([=](auto& p) { p.weights[factor] = v; });
         }});
  }
  add({"kQualityThreshold", kQualityThreshold, "--quality-threshold",
       planner(&planner_config_t::quality_threshold),
       [](double v) { checked<StopParameters>([v](auto& p) { p.quality_threshold = v; }); }});
  add({"kStopWindow",
       kStopWindow,
       "--stop-window",
       planner_int(&planner_config_t::stop_window_views),
       [](double v) {
         checked<StopParameters>([v](auto& p) { p.stop_window_views = static_cast<int>(v); });
       },
       1.0,
       {"@"},
       true});
  add({"kStopNewArea", kStopNewArea, "--stop-new-area",
       planner(&planner_config_t::stop_new_area_m2),
       [](double v) { checked<StopParameters>([v](auto& p) { p.stop_new_area_m2 = v; }); }});
  add({"kStopImprovement", kStopImprovement, "", {}, [](double v) {
         checked<StopParameters>([v](auto& p) { p.stop_improvement = v; });
       }});
  add({"kPathCost", kPathCost, "--path-cost", planner(&planner_config_t::path_cost_per_m),
       [](double v) { checked<SurfaceParameters>([v](auto& p) { p.path_cost_per_m = v; }); }});
  add({"kLeastOverlap", kLeastOverlap, "--least-overlap", planner(&planner_config_t::least_overlap),
       [](double v) { checked<SurfaceParameters>([v](auto& p) { p.min_overlap = v; }); }});
  add({"kLeastGain", kLeastGain, "--least-gain", planner(&planner_config_t::least_gain_m2),
       [](double v) { checked<SurfaceParameters>([v](auto& p) { p.least_new_area_m2 = v; }); }});

  add({"kMarginVoxels", kMarginVoxels, "--margin-voxels", {}, {}, 1.0, {"@"}, true});
  add({"kPatience", kPatience, "--patience", {}, {}});
  add({"kWindow", kWindow, "--window", {}, {}, 1.0, {"@", "1", "1"}});
  add({"kRealTime", kRealTime, "--real-time", {}, {}, 1.0, {"=@"}});
  add({"kBoundSpacing", kBoundSpacing, "--bound-spacing", {}, [](double v) {
         checked<PoseParameters>([v](auto& p) { p.spacing_m = v; });
       }});
  return all;
}

/// Why a command line is refused; empty when it is not.
std::string refusal_of_options(const Row& row, double value) {
  std::vector<std::string> arguments = {"nextview_run", row.option};
  // As many digits as tell all doubles apart.
  const std::string typed = fmt::format("{}", value * row.typed);
  for (std::string word : row.words) {
    if (const std::size_t at = word.find('@'); at != std::string::npos) word.replace(at, 1, typed);
    if (word.starts_with('=')) {
      arguments.back() += word;
    } else {
      arguments.push_back(word);
    }
  }
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  int status = 0;
  testing::internal::CaptureStderr();
  const auto options = parse_run_options(static_cast<int>(argv.size()), argv.data(), status, "");
  std::string printed = testing::internal::GetCapturedStderr();
  if (!options) return printed.empty() ? "status " + std::to_string(status) : printed;
  if (!row.read_by_set_up) return {};
  try {
    prepare_run(*options);
  } catch (const SetupError& error) {
    // Rooms of a millionth of a metre have faults of their own.
    return std::string(error.what()).find(row.option) == 0 ? error.what() : "";
  } catch (const std::exception&) {
  }
  return {};
}

std::string refusal_of_message(const Row& row, double value) {
  run_config_t config = example<run_config_t>();
  config.planner.least_gain_m2 = 0.05;
  row.message(config, value);
  return check(config);
}

std::string refusal_of_library(const Row& row, double value) {
  try {
    row.in_library(value);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

void expect_accepted(const Row& row, double value) {
  SCOPED_TRACE(fmt::format("{} {} accepted: {:.17g}", row.name, row.option, value));
  if (!row.option.empty()) {
    EXPECT_EQ(refusal_of_options(row, value), "");
  }
  if (row.message) {
    EXPECT_EQ(refusal_of_message(row, value), "");
  }
  if (row.in_library) {
    EXPECT_EQ(refusal_of_library(row, value), "");
  }
}

void expect_refused(const Row& row, double value) {
  SCOPED_TRACE(fmt::format("{} {} refused: {:.17g}", row.name, row.option, value));
  if (!row.option.empty()) {
    const std::string refusal = refusal_of_options(row, value);
    EXPECT_NE(refusal.find(row.option), std::string::npos) << refusal;
  }
  if (row.message) {
    EXPECT_NE(refusal_of_message(row, value), "");
  }
  if (row.in_library) {
    EXPECT_NE(refusal_of_library(row, value), "");
  }
}

/// The next value that can be told apart, also after degrees have become radians.
double beyond(const Row& row, double end, double sign) {
  if (row.whole) return end + sign;
  return end + sign * std::max(1e-9 * std::abs(end), 1e-12);
}

TEST(ParameterBounds, AreTheSameForOptionsMessagesAndLibraries) {
  for (const Row& row : rows()) {
    expect_accepted(row, row.whole ? row.bounds.least : beyond(row, row.bounds.least, +1.0));
    expect_accepted(row, row.whole ? row.bounds.most : beyond(row, row.bounds.most, -1.0));
    expect_refused(row, beyond(row, row.bounds.least, -1.0));
    expect_refused(row, beyond(row, row.bounds.most, +1.0));
  }
}

TEST(ParameterBounds, AreAllInTheTable) {
  std::ifstream in(std::string(NEXTVIEW_SOURCE_DIR) + "/lcmtypes/parameter_bounds.h");
  const std::string header((std::istreambuf_iterator<char>(in)), {});
  static const std::regex kBound(R"(inline constexpr Bounds (k\w+)\{)");
  std::set<std::string> in_header;
  for (std::sregex_iterator it(header.begin(), header.end(), kBound), end; it != end; ++it) {
    in_header.insert((*it)[1]);
  }
  std::set<std::string> in_table;
  for (const Row& row : rows()) in_table.insert(row.name);
  EXPECT_GE(in_header.size(), 35U);
  EXPECT_EQ(in_header, in_table);
}

TEST(ParameterBounds, TellHowManyDirectionsThereAre) {
  for (const int directions : {20, 80, 320, 1280, 5120, 20480, 0, 19, 40, 81920}) {
    const bool there =
        std::ranges::find(bounds::kDirections, directions) != bounds::kDirections.end();
    run_config_t config = example<run_config_t>();
    config.planner.directions = directions;
    EXPECT_EQ(check(config).empty(), there) << directions;
    const Row row{"", {}, "--directions", {}, {}};
    EXPECT_EQ(refusal_of_options(row, directions).empty(), there) << directions;
  }
}

/// A lift that cannot move is none, whoever is asked.
TEST(ParameterBounds, WantTheLiftsLowestBelowItsHighest) {
  for (const double highest_m : {1.0, 1.0 + 1e-6}) {
    const bool there = highest_m > 1.0;
    run_config_t config = example<run_config_t>();
    config.base.lift_min_m = 1.0;
    config.base.lift_max_m = highest_m;
    EXPECT_EQ(check(config).empty(), there);
    const auto refusal = [](const InLibrary& library) {
      return refusal_of_library({"", {}, "", {}, library}, 0.0);
    };
    EXPECT_EQ(refusal([&](double) {
                checked<FeasibilityParameters>([&](auto& p) {
                  p.lift_min_m = 1.0;
                  p.lift_max_m = highest_m;
                });
              }).empty(),
              there);
    EXPECT_EQ(refusal([&](double) {
                base_with([&](BaseLimits& l) {
                  l.lift_min_m = 1.0;
                  l.lift_max_m = highest_m;
                });
              }).empty(),
              there);
  }
}

}  // namespace
}  // namespace nextview
