#pragma once

#include <array>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <string_view>

/// What the parameters of a run may be, said once: the checks of messages, the command line's
/// options and the libraries' parameter structs all go by these. Knows no message and no LCM, so
/// that the libraries may include it.
namespace nextview {

/// A parameter's name and the finite values it may have, both ends included.
struct Bounds {
  std::string_view name;
  double least;
  double most;

  /// NaN is outside.
  constexpr bool contain(double value) const { return value >= least && value <= most; }
  /// The same for a parameter of another name.
  constexpr Bounds as(std::string_view other) const { return {other, least, most}; }
  /// Of an angle in radians.
  constexpr Bounds in_degrees() const {
    constexpr double kDegreesPerRad = 180.0 / std::numbers::pi;
    return {name, least * kDegreesPerRad, most * kDegreesPerRad};
  }
  /// "from 0 to 5", "of 0 or more", "and finite".
  std::string range() const;
  /// Empty when the value is inside, else "clearance_m = 7 is not a number from 0 to 5".
  std::string refusal(double value) const;
  /// @throws std::invalid_argument with that refusal
  void require(double value) const {
    if (!contain(value)) throw std::invalid_argument(refusal(value));
  }
};

/// Empty when a value is below another, else "lift_min_m = 3 is not below lift_max_m = 2"; NaN is
/// not.
std::string refusal_unless_below(std::string_view low_name, double low, std::string_view high_name,
                                 double high);
/// @throws std::invalid_argument with that refusal
void require_below(std::string_view low_name, double low, std::string_view high_name, double high);

namespace bounds {

constexpr double kUnlimited = std::numeric_limits<double>::max();
/// What an angle may be beyond a whole or a quarter turn: it was rounded, perhaps to a float.
constexpr double kRounded_rad = 1e-6;

// Scene.
/// Metres of a CAD file's unit; 0 in a message: as the file says.
inline constexpr Bounds kUnit{"unit_m", 1e-6, 1e6};

// Sensor.
inline constexpr Bounds kColumns{"columns", 2, 4096};
inline constexpr Bounds kRows{"rows", 2, 4096};
/// Of a sensor that looks to one side, and of one that may look all round.
inline constexpr Bounds kAperture{"aperture_rad", 1e-3, std::numbers::pi - 1e-3};
inline constexpr Bounds kTurnAperture{"aperture_rad", 1e-3, 2.0 * std::numbers::pi + kRounded_rad};
/// Of a tilted line scan whose vertical aperture follows from its horizontal one.
inline constexpr Bounds kTiltedAperture{"aperture_rad", 1e-3, 0.5 * std::numbers::pi - 1e-3};
inline constexpr Bounds kBaseline{"baseline_m", 0.0, 10.0};
inline constexpr Bounds kRangeMin{"range_min_m", 0.0, 1e5};
inline constexpr Bounds kRangeMax{"range_max_m", 1e-4, 1e5};
inline constexpr Bounds kRangeNoise{"range_noise_m", 0.0, 100.0};
inline constexpr Bounds kScanDuration{"scan_duration_s", 0.0, 1e6};

// Base.
/// In a CAD file's coordinates, which may be those of a map of the country.
inline constexpr Bounds kPosition{"a position, m", -1e9, 1e9};
/// In the world of a run. Beyond this floats no longer tell millimetres apart.
inline constexpr Bounds kWorkspace{"workspace_min_m or workspace_max_m", -8192.0, 8192.0};
inline constexpr Bounds kPan{"pan_rad", -2.0 * std::numbers::pi - kRounded_rad,
                             2.0 * std::numbers::pi + kRounded_rad};
inline constexpr Bounds kTilt{"tilt_rad", -0.5 * std::numbers::pi - kRounded_rad,
                              0.5 * std::numbers::pi + kRounded_rad};
inline constexpr Bounds kBodyRadius{"body_radius_m", 1e-4, 5.0};
inline constexpr Bounds kLift{"lift_min_m or lift_max_m", kWorkspace.least, kWorkspace.most};
inline constexpr Bounds kBaseSpeed{"base_speed_m_s", 1e-6, 1e6};
inline constexpr Bounds kLiftSpeed{"lift_speed_m_s", 1e-6, 1e6};
inline constexpr Bounds kTurnSpeed{"turn_speed_rad_s", 1e-8, 1e6};

// Map.
inline constexpr Bounds kVoxelSize{"voxel_size_m", 0.001, 10.0};
inline constexpr Bounds kWindowSize{"window_size", 1, 4096};
inline constexpr Bounds kWindowMin{"window_min", -1e9, 1e9};

// Planner.
inline constexpr Bounds kMaxViews{"max_views", 1, 1e6};
inline constexpr Bounds kMaxAttempts{"max_attempts", 1, 1e6};
inline constexpr Bounds kThreads{"threads", 1, 256};
inline constexpr Bounds kStep{"step_min_m or step_max_m", 1e-4, 1e5};
inline constexpr Bounds kFitnessTolerance{"fitness_tolerance", 0.0, 2.0};
/// Orientations a view is chosen among: the faces of an icosahedron, each parted in four again. The
/// last are 1.4 degrees apart, which is what a panorama tells apart.
inline constexpr std::array<int, 6> kDirections{20, 80, 320, 1280, 5120, 20480};
/// Both 0: the planner chooses. A view is predicted in many orientations at many positions.
inline constexpr Bounds kPredictionRays{"prediction_columns or prediction_rows", 2, 512};
/// What was tried for one goal has to fit one search_t.
inline constexpr Bounds kMaxEvaluations{"max_evaluations", 4, 1200};
inline constexpr Bounds kClearance{"clearance_m", 0.0, 5.0};
inline constexpr Bounds kDeparture{"departure_m", 0.0, 5.0};
inline constexpr Bounds kFactorWeight{"structure_weight or navigation_weight", 0.0, 10.0};
inline constexpr Bounds kQualityThreshold{"quality_threshold", 0.0, 1.0};
inline constexpr Bounds kStopWindow{"stop_window_views", 1, 1e6};
inline constexpr Bounds kPathCost{"path_cost_per_m", 0.0, 10.0};
inline constexpr Bounds kLeastOverlap{"least_overlap", 0.0, 0.99};
/// 0 in a message: the strategy has no use for it.
inline constexpr Bounds kLeastGain{"least_gain_m2", 1e-6, 1e6};
inline constexpr Bounds kStopNewArea{"stop_new_area_m2", 0.0, 1e6};
inline constexpr Bounds kStopImprovement{"stop_improvement", 0.0, 1.0};

// Of ./run and nextview_bound alone.
inline constexpr Bounds kMarginVoxels{"margin_voxels", 0, 1000};
inline constexpr Bounds kPatience{"patience_s", 0.1, 1e6};
inline constexpr Bounds kWindow{"window_m", 0.001, kWorkspace.most};
inline constexpr Bounds kRealTime{"real_time", 0.001, 1e6};
inline constexpr Bounds kBoundSpacing{"spacing_m", 0.05, 100.0};

}  // namespace bounds

}  // namespace nextview
