#include "lcmtypes/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "lcmtypes/message_bounds.h"
#include "lcmtypes/validate_checks.h"
#include "sensor/range_image_check.h"

namespace nextview {
namespace {

template <class Message>
Checks check_key(const Message& message) {
  Checks checks;
  checks.within(bounds::kTime, static_cast<double>(message.utime));
  if constexpr (requires { message.view; }) {
    checks.require(message.view >= 1, fmt::format("view {}", message.view));
    checks.require(message.attempt >= 1, fmt::format("attempt {}", message.attempt));
  }
  return checks;
}

void check_angles(Checks& checks, double pan_rad, double tilt_rad) {
  checks.within(bounds::kPan, pan_rad);
  checks.within(bounds::kTilt, tilt_rad);
}

void check_place(Checks& checks, std::string_view name, std::span<const double> position_m) {
  checks.finite(name, position_m);
  checks.within(bounds::kPlace.as(name), position_m);
}

Eigen::Matrix3d matrix_of(const double (&m)[3][3]) {
  Eigen::Matrix3d matrix;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) matrix(i, j) = m[i][j];
  }
  return matrix;
}

void check_part(Checks& checks, const range_image_t& image) {
  checks.within(bounds::kColumns, image.columns);
  checks.within(bounds::kRows, image.rows);
  const std::int64_t all_entries = std::int64_t{image.columns} + image.rows;
  const std::int64_t all_pixels = std::int64_t{image.columns} * image.rows;
  const std::int64_t entry_end = std::int64_t{image.first_entry} + image.entries;
  const std::int64_t pixel_end = std::int64_t{image.first_pixel} + image.pixels;
  checks.require(image.parts >= 1 && image.parts <= all_entries + all_pixels,
                 fmt::format("parts {}", image.parts));
  checks.require(image.part >= 0 && image.part < image.parts,
                 fmt::format("part {} of {}", image.part, image.parts));
  checks.require(image.entries >= 0 && image.first_entry >= 0 && entry_end <= all_entries,
                 fmt::format("entries {} to {} of {}", image.first_entry, entry_end, all_entries));
  checks.require(image.pixels >= 0 && image.first_pixel >= 0 && pixel_end <= all_pixels,
                 fmt::format("pixels {} to {} of {}", image.first_pixel, pixel_end, all_pixels));
  checks.require(image.entries + std::int64_t{image.pixels} >= 1, "an empty part");
  // One slice: pixels follow the last entry, and where there are none of either the slice says so.
  checks.require(image.pixels > 0 ? entry_end == all_entries : image.first_pixel == 0,
                 "pixels before the last entry");
  checks.require(image.entries == 0 || image.pixels == 0 || image.first_pixel == 0,
                 "pixels that do not follow the entries");
  const bool begins = image.entries > 0 && image.first_entry == 0;
  const bool ends = image.pixels > 0 && pixel_end == all_pixels;
  checks.require(
      (image.part == 0) == begins && (std::int64_t{image.part} + 1 == image.parts) == ends,
      "the first or last of the image in the wrong part");
}

/// As many names as values, each of them a word.
void check_names(Checks& checks, std::string_view field, std::string_view list,
                 std::size_t values) {
  const std::vector<std::string_view> names = names_of(list);
  checks.require(names.size() == values,
                 fmt::format("{} has {} names for {} values", field, names.size(), values));
  for (const std::string_view name : names) {
    checks.require(
        !name.empty() && name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") ==
                             std::string_view::npos,
        std::string(field) + " has a name that is no word of a-z, 0-9 and _");
  }
}

/// What somebody asks for, and who.
template <class Request>
void check_wanted(Checks& checks, const Request& request) {
  bool known = false;
  for_each_channel(
      [&]<class Message>() { known |= request.wanted_channel == Channel<Message>::name; });
  checks.require(known, "asks for a channel nobody has");
  checks.require(!request.asker.empty(), "no asker");
}

std::int64_t occupied_in(const map_blocks_t& blocks) {
  constexpr std::uint8_t kOccupied = 4;
  std::int64_t occupied = 0;
  for (const auto& labels : blocks.block_label) {
    occupied += std::count(labels.begin(), labels.end(), kOccupied);
  }
  return occupied;
}

void check_surfaces(Checks& checks, const map_blocks_t& blocks) {
  constexpr double kFloatTolerance = 1e-3;
  checks.require(occupied_in(blocks) == blocks.surfaces,
                 std::to_string(blocks.surfaces) + " surfaces for " +
                     std::to_string(occupied_in(blocks)) + " Occupied voxels");
  for (const auto& normal : blocks.surface_normal) {
    const double length = Eigen::Vector3f(normal.data()).norm();
    checks.require(length == 0.0 || std::abs(length - 1.0) <= kFloatTolerance,
                   "surface_normal is neither a unit vector nor zero");
  }
  for (const float quality : blocks.surface_quality) {
    checks.within("surface_quality", quality, 0.0, 1.0);
  }
}

}  // namespace

std::string check(const goal_t& goal) {
  Checks checks = check_key(goal);
  checks.require(goal.waypoints >= 1, "no waypoint");
  check_place(checks, "position_m", goal.position_m);
  check_angles(checks, goal.pan_rad, goal.tilt_rad);
  for (const auto& waypoint : goal.waypoint_m) check_place(checks, "waypoint_m", waypoint);
  checks.not_negative("path_length_m", goal.path_length_m);
  checks.not_negative("fitness", goal.fitness);
  checks.within("share_occupied", goal.share_occupied, 0.0, 1.0);
  checks.within("share_occlusion_plane", goal.share_occlusion_plane, 0.0, 1.0);
  checks.within("share_unseen", goal.share_unseen, 0.0, 1.0);
  checks.within("share_open", goal.share_open, 0.0, 1.0);
  for (const double factor : goal.factor_value) checks.within("factor_value", factor, 0.0, 1.0);
  check_names(checks, "factor_names", goal.factor_names, goal.factor_value.size());
  checks.not_negative("expected_gain_m2", goal.expected_gain_m2);
  checks.within("overlap", goal.overlap, 0.0, 1.0);
  checks.not_negative("iterations", goal.iterations);
  checks.not_negative("evaluations", goal.evaluations);
  checks.require(!goal.strategy.empty(), "no strategy");
  return checks.reason();
}

std::string check(const search_t& search) {
  Checks checks = check_key(search);
  for (const auto& position : search.tried_position_m) checks.finite("tried_position_m", position);
  checks.finite("tried_pan_rad", search.tried_pan_rad);
  checks.finite("tried_tilt_rad", search.tried_tilt_rad);
  checks.finite("tried_fitness", search.tried_fitness);
  for (const std::int8_t move : search.tried_move) checks.within("tried_move", move, 0, 15);
  return checks.reason();
}

std::string check(const arrival_t& arrival) {
  Checks checks = check_key(arrival);
  checks.within("arrived", arrival.arrived, 0, 1);
  check_place(checks, "true_position_m", arrival.true_position_m);
  check_angles(checks, arrival.true_pan_rad, arrival.true_tilt_rad);
  check_place(checks, "believed_position_m", arrival.believed_position_m);
  check_angles(checks, arrival.believed_pan_rad, arrival.believed_tilt_rad);
  checks.not_negative("path_length_m", arrival.path_length_m);
  checks.require((arrival.arrived == 0) != arrival.refusal.empty(),
                 "arrived and refused, or neither");
  return checks.reason();
}

std::string check(const range_image_t& image) {
  Checks checks = check_key(image);
  checks.require(image.geometry >= 0 && image.geometry < kSensorKinds,
                 fmt::format("geometry {}", image.geometry));
  check_part(checks, image);
  checks.require(on_unit_circle(image.entry_sin, image.entry_cos),
                 "sine and cosine of a column or row do not belong together");
  checks.within(bounds::kRangeMin, image.range_min_m);
  checks.within(bounds::kRangeMax, image.range_max_m);
  checks.require(are_range_limits({image.range_min_m, image.range_max_m}),
                 "range_min_m is not below range_max_m");
  check_place(checks, "position_m", image.position_m);
  check_angles(checks, image.pan_rad, image.tilt_rad);
  checks.require(is_rotation(matrix_of(image.world_from_sensor)),
                 "world_from_sensor is not a rotation");
  checks.require(are_ranges(image.range_m), "a range is negative or -inf");
  return checks.reason();
}

std::string check(const commit_t& commit) {
  Checks checks = check_key(commit);
  check_place(checks, "used_position_m", commit.used_position_m);
  check_angles(checks, commit.pan_rad, commit.tilt_rad);
  for (const std::int64_t count :
       {commit.unmarked_voxels, commit.occluded_voxels, commit.occlusion_plane_voxels,
        commit.empty_voxels, commit.occupied_voxels, commit.newly_occupied_voxels, commit.points,
        commit.points_outside, commit.no_returns, commit.invalid}) {
    checks.require(count >= 0, fmt::format("count {}", count));
  }
  checks.require(commit.newly_occupied_voxels <= commit.occupied_voxels,
                 "more voxels newly Occupied than Occupied");
  checks.not_negative("occupied_area_m2", commit.occupied_area_m2);
  checks.not_negative("occlusion_plane_area_m2", commit.occlusion_plane_area_m2);
  checks.within("mean_quality", commit.mean_quality, 0.0, 1.0);
  checks.within("min_quality", commit.min_quality, 0.0, 1.0);
  checks.digest("map_digest", commit.map_digest);
  checks.digest("history_digest", commit.history_digest);
  return checks.reason();
}

std::string check(const stop_t& stop) {
  Checks checks = check_key(stop);
  checks.not_negative("views", stop.views);
  checks.not_negative("final_attempt", stop.final_attempt);
  checks.require(!stop.stop_reason.empty(), "no stop_reason");
  return checks.reason();
}

std::string check(const status_t& status) {
  Checks checks = check_key(status);
  for (const std::int64_t count :
       {status.lost, status.repeated, status.foreign, status.refused, status.peak_memory_bytes}) {
    checks.require(count >= 0, fmt::format("count {}", count));
  }
  checks.within("failed", status.failed, 0, 1);
  checks.require(!status.role.empty(), "no role");
  checks.require(!status.program_version.empty(), "no program_version");
  return checks.reason();
}

std::string check(const request_t& request) {
  Checks checks;
  checks.within(bounds::kTime, static_cast<double>(request.utime));
  checks.require(request.view >= 0, fmt::format("view {}", request.view));
  checks.require(request.attempt >= 0, fmt::format("attempt {}", request.attempt));
  check_wanted(checks, request);
  return checks.reason();
}

std::string check(const timing_t& timing) {
  Checks checks;
  checks.within(bounds::kTime, static_cast<double>(timing.utime));
  checks.require(timing.view >= 1, fmt::format("view {}", timing.view));
  checks.require(timing.attempt >= 0, fmt::format("attempt {}", timing.attempt));
  for (const double duration_s : timing.duration_s) checks.not_negative("duration_s", duration_s);
  checks.require(!timing.role.empty(), "no role");
  check_names(checks, "duration_names", timing.duration_names, timing.duration_s.size());
  return checks.reason();
}

std::string check(const map_blocks_t& blocks) {
  constexpr std::uint8_t kLargestLabel = 4;
  Checks checks;
  checks.within(bounds::kTime, static_cast<double>(blocks.utime));
  checks.require(
      blocks.since_view >= 0 && blocks.view >= blocks.since_view,
      "view " + std::to_string(blocks.view) + " since view " + std::to_string(blocks.since_view));
  checks.require(blocks.part >= 0 && blocks.part < blocks.parts,
                 "part " + std::to_string(blocks.part) + " of " + std::to_string(blocks.parts));
  checks.require(blocks.blocks > 0 || blocks.parts == 1, "an empty part");
  checks.within(bounds::kVoxelSize, blocks.voxel_size_m);
  checks.finite("map_origin_m", blocks.map_origin_m);
  for (const std::int32_t size : blocks.window_size) {
    checks.require(size >= 1, "window_size " + std::to_string(size));
  }
  for (const auto& labels : blocks.block_label) {
    checks.require(std::all_of(labels.begin(), labels.end(),
                               [](std::uint8_t label) { return label <= kLargestLabel; }),
                   "block_label that is no label");
  }
  check_surfaces(checks, blocks);
  return checks.reason();
}

std::string check(const pace_t& pace) {
  constexpr double kLongestHold_s = 60.0;
  Checks checks;
  checks.require(pace.utime == 0, "utime " + std::to_string(pace.utime) + " is not 0");
  checks.require(pace.pace_number >= 0, "pace_number " + std::to_string(pace.pace_number));
  checks.require(pace.last_view >= 0, "last_view " + std::to_string(pace.last_view));
  checks.within("holds_s", pace.holds_s, 0.0, kLongestHold_s);
  return checks.reason();
}

std::string check(const seal_t& seal) {
  Checks checks;
  checks.not_negative("utime", static_cast<double>(seal.utime));
  const auto channels = static_cast<std::size_t>(seal.sealed_channels);
  const std::vector<std::string_view> names = names_of(seal.channel_names);
  const std::vector<std::string_view> digests = names_of(seal.channel_digests);
  checks.require(names.size() == channels && digests.size() == channels,
                 fmt::format("{} names and {} digests for {} channels", names.size(),
                             digests.size(), channels));
  for (const std::int64_t messages : seal.distinct_messages) {
    checks.require(messages >= 0, fmt::format("count {}", messages));
  }
  for (const std::string_view digest : digests) checks.digest("channel_digests", digest);
  checks.digest("times_digest", seal.times_digest);
  return checks.reason();
}

std::string check(const parts_request_t& request) {
  Checks checks;
  checks.within(bounds::kTime, static_cast<double>(request.utime));
  checks.require(request.view >= 1, fmt::format("view {}", request.view));
  checks.require(request.attempt >= 1, fmt::format("attempt {}", request.attempt));
  checks.require(request.ranges >= 1, "asks for no part");
  std::int64_t before = -1;
  for (std::size_t i = 0; i < request.first_wanted_part.size(); ++i) {
    const std::int32_t first = request.first_wanted_part[i];
    const std::int32_t last = request.last_wanted_part[i];
    checks.require(first > before && last >= first,
                   fmt::format("parts {} to {} after part {}", first, last, before));
    before = last;
  }
  check_wanted(checks, request);
  return checks.reason();
}

std::string check(const recorded_t& recorded) {
  Checks checks;
  checks.require(recorded.utime == 0, fmt::format("utime {} is not 0", recorded.utime));
  checks.require(recorded.recorded_views >= 0,
                 fmt::format("recorded_views {}", recorded.recorded_views));
  return checks.reason();
}

std::vector<std::string_view> names_of(std::string_view list) {
  std::vector<std::string_view> names;
  if (list.empty()) return names;
  for (std::size_t comma; (comma = list.find(',')) != std::string_view::npos;) {
    names.push_back(list.substr(0, comma));
    list.remove_prefix(comma + 1);
  }
  names.push_back(list);
  return names;
}

}  // namespace nextview
