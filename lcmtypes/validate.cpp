#include "lcmtypes/validate.h"

#include <cstdint>
#include <limits>
#include <numbers>

#include "lcmtypes/validate_checks.h"

namespace nextview {
namespace {

constexpr double kHalfTurn = std::numbers::pi;
constexpr double kQuarterTurn = std::numbers::pi / 2.0;
/// Sines, cosines and rotations may be off by rounding, not by more.
constexpr double kUnitTolerance = 1e-9;
/// Ranges are rounded to 0.1 mm, also at the limit.
constexpr double kRangeTolerance_m = 1e-3;

template <class Message>
Checks check_key(const Message& message) {
  Checks checks;
  checks.not_negative("utime", static_cast<double>(message.utime));
  if constexpr (requires { message.view; }) {
    checks.require(message.view >= 1, "view " + std::to_string(message.view));
    checks.require(message.attempt >= 1, "attempt " + std::to_string(message.attempt));
  }
  return checks;
}

void check_angles(Checks& checks, double pan_rad, double tilt_rad) {
  checks.within("pan_rad", pan_rad, -2.0 * kHalfTurn, 2.0 * kHalfTurn);
  checks.within("tilt_rad", tilt_rad, -kQuarterTurn - kUnitTolerance,
                kQuarterTurn + kUnitTolerance);
}

bool on_unit_circle(const std::vector<double>& sines, const std::vector<double>& cosines) {
  for (std::size_t i = 0; i < sines.size(); ++i) {
    const double square = sines[i] * sines[i] + cosines[i] * cosines[i];
    if (!(std::abs(square - 1.0) <= kUnitTolerance)) return false;
  }
  return true;
}

bool is_rotation(const double (&m)[3][3]) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double dot = m[i][0] * m[j][0] + m[i][1] * m[j][1] + m[i][2] * m[j][2];
      if (!(std::abs(dot - (i == j ? 1.0 : 0.0)) <= kUnitTolerance)) return false;
    }
  }
  const double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                             m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return determinant > 0.0;
}

void check_part(Checks& checks, const range_image_t& image) {
  checks.require(image.columns >= 2 && image.rows >= 2 &&
                     std::int64_t{image.columns} + image.rows <= kMaxColumnsAndRows,
                 "raster of " + std::to_string(image.columns) + " x " + std::to_string(image.rows));
  const std::int64_t all = std::int64_t{image.columns} * image.rows;
  const std::int64_t end = std::int64_t{image.first_pixel} + image.pixels;
  checks.require(image.parts >= 1 && image.parts <= all, "parts " + std::to_string(image.parts));
  checks.require(image.part >= 0 && image.part < image.parts,
                 "part " + std::to_string(image.part) + " of " + std::to_string(image.parts));
  checks.require(image.pixels >= 1 && image.first_pixel >= 0 && end <= all,
                 "pixels " + std::to_string(image.first_pixel) + " to " + std::to_string(end) +
                     " of " + std::to_string(all));
  checks.require((image.part == 0) == (image.first_pixel == 0) &&
                     (std::int64_t{image.part} + 1 == image.parts) == (end == all),
                 "first or last pixels in the wrong part");
}

// NaN and +inf are said on purpose: invalid and no return. The loop goes on to the end, wrong or
// not, because only then compilers make vectors of it.
bool are_ranges(const std::vector<float>& range_m, double range_max_m) {
  const double longest_m = range_max_m + kRangeTolerance_m;
  int wrong = 0;
  for (const float m : range_m) {
    const int is_finite = m <= std::numeric_limits<float>::max();
    const int is_beyond = static_cast<double>(m) > longest_m;
    const int is_negative = m < 0.0F;
    wrong |= is_negative | (is_finite & is_beyond);
  }
  return wrong == 0;
}

}  // namespace

std::string check(const goal_t& goal) {
  Checks checks = check_key(goal);
  checks.require(goal.waypoints >= 1, "no waypoint");
  checks.finite("position_m", goal.position_m);
  check_angles(checks, goal.pan_rad, goal.tilt_rad);
  for (const auto& waypoint : goal.waypoint_m) checks.finite("waypoint_m", waypoint);
  checks.not_negative("fitness", goal.fitness);
  checks.within("share_occupied", goal.share_occupied, 0.0, 1.0);
  checks.within("share_occlusion_plane", goal.share_occlusion_plane, 0.0, 1.0);
  checks.within("share_unseen", goal.share_unseen, 0.0, 1.0);
  checks.within("share_open", goal.share_open, 0.0, 1.0);
  checks.within("quality_factor", goal.quality_factor, 0.0, 1.0);
  checks.not_negative("iterations", goal.iterations);
  checks.not_negative("evaluations", goal.evaluations);
  checks.not_negative("plan_wall_s", goal.plan_wall_s);
  return checks.reason();
}

std::string check(const search_t& search) {
  Checks checks = check_key(search);
  for (const auto& position : search.tried_position_m) checks.finite("tried_position_m", position);
  checks.finite("tried_pan_rad", search.tried_pan_rad);
  checks.finite("tried_tilt_rad", search.tried_tilt_rad);
  checks.finite("tried_fitness", search.tried_fitness);
  for (const std::int8_t move : search.tried_move) checks.within("tried_move", move, 0, 5);
  checks.not_negative("fold_wall_s", search.fold_wall_s);
  checks.not_negative("wait_wall_s", search.wait_wall_s);
  return checks.reason();
}

std::string check(const arrival_t& arrival) {
  Checks checks = check_key(arrival);
  checks.within("arrived", arrival.arrived, 0, 1);
  checks.finite("arrival_position_m", arrival.arrival_position_m);
  check_angles(checks, arrival.pan_rad, arrival.tilt_rad);
  checks.not_negative("path_length_m", arrival.path_length_m);
  checks.not_negative("move_wall_s", arrival.move_wall_s);
  checks.require((arrival.arrived == 0) != arrival.refusal.empty(),
                 "arrived and refused, or neither");
  return checks.reason();
}

std::string check(const range_image_t& image) {
  Checks checks = check_key(image);
  checks.require(image.geometry == 0, "geometry " + std::to_string(image.geometry));
  check_part(checks, image);
  checks.require(on_unit_circle(image.column_sin, image.column_cos),
                 "sine and cosine of a column do not belong together");
  checks.require(on_unit_circle(image.row_sin, image.row_cos),
                 "sine and cosine of a row do not belong together");
  checks.not_negative("range_min_m", image.range_min_m);
  checks.positive("range_max_m", image.range_max_m);
  checks.require(image.range_min_m < image.range_max_m, "range_min_m is not below range_max_m");
  checks.finite("position_m", image.position_m);
  check_angles(checks, image.pan_rad, image.tilt_rad);
  checks.require(is_rotation(image.world_from_sensor), "world_from_sensor is not a rotation");
  checks.require(are_ranges(image.range_m, image.range_max_m),
                 "a range is negative, -inf or beyond range_max_m");
  checks.not_negative("scan_wall_s", image.scan_wall_s);
  return checks.reason();
}

std::string check(const commit_t& commit) {
  Checks checks = check_key(commit);
  checks.finite("used_position_m", commit.used_position_m);
  check_angles(checks, commit.pan_rad, commit.tilt_rad);
  for (const std::int64_t count :
       {commit.unmarked_voxels, commit.occluded_voxels, commit.occlusion_plane_voxels,
        commit.empty_voxels, commit.occupied_voxels, commit.newly_occupied_voxels, commit.points,
        commit.points_outside, commit.no_returns, commit.invalid}) {
    checks.require(count >= 0, "count " + std::to_string(count));
  }
  checks.require(commit.newly_occupied_voxels <= commit.occupied_voxels,
                 "more voxels newly Occupied than Occupied");
  checks.not_negative("occupied_area_m2", commit.occupied_area_m2);
  checks.not_negative("occlusion_plane_area_m2", commit.occlusion_plane_area_m2);
  checks.within("mean_quality", commit.mean_quality, 0.0, 1.0);
  checks.within("min_quality", commit.min_quality, 0.0, 1.0);
  checks.digest("map_digest", commit.map_digest);
  checks.not_negative("update_wall_s", commit.update_wall_s);
  checks.not_negative("digest_wall_s", commit.digest_wall_s);
  return checks.reason();
}

std::string check(const stop_t& stop) {
  Checks checks = check_key(stop);
  checks.not_negative("views", stop.views);
  checks.not_negative("final_attempt", stop.final_attempt);
  checks.not_negative("fold_wall_s", stop.fold_wall_s);
  checks.not_negative("wait_wall_s", stop.wait_wall_s);
  checks.require(!stop.stop_reason.empty(), "no stop_reason");
  return checks.reason();
}

std::string check(const status_t& status) {
  Checks checks = check_key(status);
  for (const std::int64_t count :
       {status.strangers, status.duplicates, status.dropped, status.peak_memory_bytes}) {
    checks.require(count >= 0, "count " + std::to_string(count));
  }
  checks.within("failed", status.failed, 0, 1);
  checks.require(!status.role.empty(), "no role");
  return checks.reason();
}

std::string check(const request_t& request) {
  Checks checks;
  checks.not_negative("utime", static_cast<double>(request.utime));
  checks.require(request.view >= 0, "view " + std::to_string(request.view));
  checks.require(request.attempt >= 0, "attempt " + std::to_string(request.attempt));
  bool known = false;
  for_each_channel(
      [&]<class Message>() { known |= request.wanted_channel == Channel<Message>::name; });
  checks.require(known, "asks for a channel nobody has");
  checks.require(!request.asker.empty(), "no asker");
  return checks.reason();
}

}  // namespace nextview
