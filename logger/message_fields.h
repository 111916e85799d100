#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "lcmtypes/channels.h"

namespace nextview {

/// The fields of a message by name, in the order of its .lcm file, for whoever handles all fields
/// alike: replay names the one that differs. A test holds every list against its .lcm file.
template <class Message>
struct MessageFields;  // static constexpr std::tuple of NamedField

template <class Message, class Value>
struct NamedField {
  std::string_view name;
  Value Message::*member;
};
template <class Message, class Value>
NamedField(const char*, Value Message::*) -> NamedField<Message, Value>;

template <>
struct MessageFields<base_config_t> {
  using M = base_config_t;
  static constexpr auto list = std::tuple{NamedField{"start_m", &M::start_m},
                                          NamedField{"start_pan_rad", &M::start_pan_rad},
                                          NamedField{"start_tilt_rad", &M::start_tilt_rad},
                                          NamedField{"body_radius_m", &M::body_radius_m},
                                          NamedField{"workspace_min_m", &M::workspace_min_m},
                                          NamedField{"workspace_max_m", &M::workspace_max_m},
                                          NamedField{"lift_min_m", &M::lift_min_m},
                                          NamedField{"lift_max_m", &M::lift_max_m},
                                          NamedField{"base_speed_m_s", &M::base_speed_m_s},
                                          NamedField{"lift_speed_m_s", &M::lift_speed_m_s},
                                          NamedField{"turn_speed_rad_s", &M::turn_speed_rad_s}};
};
template <>
struct MessageFields<map_config_t> {
  using M = map_config_t;
  static constexpr auto list = std::tuple{
      NamedField{"voxel_size_m", &M::voxel_size_m}, NamedField{"map_origin_m", &M::map_origin_m},
      NamedField{"window_min", &M::window_min}, NamedField{"window_size", &M::window_size}};
};
template <>
struct MessageFields<planner_config_t> {
  using M = planner_config_t;
  static constexpr auto list = std::tuple{NamedField{"max_views", &M::max_views},
                                          NamedField{"max_attempts", &M::max_attempts},
                                          NamedField{"threads", &M::threads},
                                          NamedField{"directions", &M::directions},
                                          NamedField{"prediction_columns", &M::prediction_columns},
                                          NamedField{"prediction_rows", &M::prediction_rows},
                                          NamedField{"max_evaluations", &M::max_evaluations},
                                          NamedField{"step_min_m", &M::step_min_m},
                                          NamedField{"step_max_m", &M::step_max_m},
                                          NamedField{"fitness_tolerance", &M::fitness_tolerance},
                                          NamedField{"quality_weight", &M::quality_weight},
                                          NamedField{"structure_weight", &M::structure_weight},
                                          NamedField{"navigation_weight", &M::navigation_weight},
                                          NamedField{"path_cost_per_m", &M::path_cost_per_m},
                                          NamedField{"clearance_m", &M::clearance_m},
                                          NamedField{"departure_m", &M::departure_m},
                                          NamedField{"later_departure_m", &M::later_departure_m},
                                          NamedField{"least_overlap", &M::least_overlap},
                                          NamedField{"stop_rule", &M::stop_rule},
                                          NamedField{"quality_threshold", &M::quality_threshold},
                                          NamedField{"stop_window_views", &M::stop_window_views},
                                          NamedField{"stop_new_area_m2", &M::stop_new_area_m2},
                                          NamedField{"least_gain_m2", &M::least_gain_m2},
                                          NamedField{"return_home", &M::return_home}};
};
template <>
struct MessageFields<scene_config_t> {
  using M = scene_config_t;
  static constexpr auto list = std::tuple{NamedField{"unit_m", &M::unit_m},
                                          NamedField{"origin_in_file_m", &M::origin_in_file_m}};
};
template <>
struct MessageFields<sensor_config_t> {
  using M = sensor_config_t;
  static constexpr auto list = std::tuple{NamedField{"geometry", &M::geometry},
                                          NamedField{"geometry_parameter", &M::geometry_parameter},
                                          NamedField{"columns", &M::columns},
                                          NamedField{"rows", &M::rows},
                                          NamedField{"range_min_m", &M::range_min_m},
                                          NamedField{"range_max_m", &M::range_max_m},
                                          NamedField{"range_noise_m", &M::range_noise_m},
                                          NamedField{"scan_duration_s", &M::scan_duration_s}};
};
template <>
struct MessageFields<run_config_t> {
  using M = run_config_t;
  static constexpr auto list = std::tuple{NamedField{"utime", &M::utime},
                                          NamedField{"run", &M::run},
                                          NamedField{"seed", &M::seed},
                                          NamedField{"has_scene", &M::has_scene},
                                          NamedField{"scene", &M::scene},
                                          NamedField{"sensor", &M::sensor},
                                          NamedField{"base", &M::base},
                                          NamedField{"map", &M::map},
                                          NamedField{"planner", &M::planner},
                                          NamedField{"scene_name", &M::scene_name},
                                          NamedField{"scene_file", &M::scene_file},
                                          NamedField{"scene_up", &M::scene_up},
                                          NamedField{"scene_digest", &M::scene_digest},
                                          NamedField{"strategy", &M::strategy},
                                          NamedField{"program_version", &M::program_version}};
};
template <>
struct MessageFields<goal_t> {
  using M = goal_t;
  static constexpr auto list =
      std::tuple{NamedField{"utime", &M::utime},
                 NamedField{"waypoints", &M::waypoints},
                 NamedField{"factors", &M::factors},
                 NamedField{"run", &M::run},
                 NamedField{"view", &M::view},
                 NamedField{"attempt", &M::attempt},
                 NamedField{"position_m", &M::position_m},
                 NamedField{"pan_rad", &M::pan_rad},
                 NamedField{"tilt_rad", &M::tilt_rad},
                 NamedField{"waypoint_m", &M::waypoint_m},
                 NamedField{"path_length_m", &M::path_length_m},
                 NamedField{"fitness", &M::fitness},
                 NamedField{"share_occupied", &M::share_occupied},
                 NamedField{"share_occlusion_plane", &M::share_occlusion_plane},
                 NamedField{"share_unseen", &M::share_unseen},
                 NamedField{"share_open", &M::share_open},
                 NamedField{"factor_value", &M::factor_value},
                 NamedField{"expected_gain_m2", &M::expected_gain_m2},
                 NamedField{"overlap", &M::overlap},
                 NamedField{"iterations", &M::iterations},
                 NamedField{"evaluations", &M::evaluations},
                 NamedField{"factor_names", &M::factor_names},
                 NamedField{"strategy", &M::strategy},
                 NamedField{"reason", &M::reason}};
};
template <>
struct MessageFields<search_t> {
  using M = search_t;
  static constexpr auto list = std::tuple{NamedField{"utime", &M::utime},
                                          NamedField{"tried", &M::tried},
                                          NamedField{"run", &M::run},
                                          NamedField{"view", &M::view},
                                          NamedField{"attempt", &M::attempt},
                                          NamedField{"tried_position_m", &M::tried_position_m},
                                          NamedField{"tried_pan_rad", &M::tried_pan_rad},
                                          NamedField{"tried_tilt_rad", &M::tried_tilt_rad},
                                          NamedField{"tried_fitness", &M::tried_fitness},
                                          NamedField{"tried_move", &M::tried_move}};
};
template <>
struct MessageFields<arrival_t> {
  using M = arrival_t;
  static constexpr auto list =
      std::tuple{NamedField{"utime", &M::utime},
                 NamedField{"run", &M::run},
                 NamedField{"view", &M::view},
                 NamedField{"attempt", &M::attempt},
                 NamedField{"arrived", &M::arrived},
                 NamedField{"true_position_m", &M::true_position_m},
                 NamedField{"true_pan_rad", &M::true_pan_rad},
                 NamedField{"true_tilt_rad", &M::true_tilt_rad},
                 NamedField{"believed_position_m", &M::believed_position_m},
                 NamedField{"believed_pan_rad", &M::believed_pan_rad},
                 NamedField{"believed_tilt_rad", &M::believed_tilt_rad},
                 NamedField{"path_length_m", &M::path_length_m},
                 NamedField{"refusal", &M::refusal}};
};
template <>
struct MessageFields<range_image_t> {
  using M = range_image_t;
  static constexpr auto list = std::tuple{NamedField{"utime", &M::utime},
                                          NamedField{"entries", &M::entries},
                                          NamedField{"pixels", &M::pixels},
                                          NamedField{"run", &M::run},
                                          NamedField{"view", &M::view},
                                          NamedField{"attempt", &M::attempt},
                                          NamedField{"part", &M::part},
                                          NamedField{"parts", &M::parts},
                                          NamedField{"geometry", &M::geometry},
                                          NamedField{"columns", &M::columns},
                                          NamedField{"rows", &M::rows},
                                          NamedField{"range_min_m", &M::range_min_m},
                                          NamedField{"range_max_m", &M::range_max_m},
                                          NamedField{"position_m", &M::position_m},
                                          NamedField{"pan_rad", &M::pan_rad},
                                          NamedField{"tilt_rad", &M::tilt_rad},
                                          NamedField{"world_from_sensor", &M::world_from_sensor},
                                          NamedField{"first_entry", &M::first_entry},
                                          NamedField{"entry_sin", &M::entry_sin},
                                          NamedField{"entry_cos", &M::entry_cos},
                                          NamedField{"first_pixel", &M::first_pixel},
                                          NamedField{"range_m", &M::range_m}};
};
template <>
struct MessageFields<commit_t> {
  using M = commit_t;
  static constexpr auto list =
      std::tuple{NamedField{"utime", &M::utime},
                 NamedField{"run", &M::run},
                 NamedField{"view", &M::view},
                 NamedField{"attempt", &M::attempt},
                 NamedField{"used_position_m", &M::used_position_m},
                 NamedField{"pan_rad", &M::pan_rad},
                 NamedField{"tilt_rad", &M::tilt_rad},
                 NamedField{"unmarked_voxels", &M::unmarked_voxels},
                 NamedField{"occluded_voxels", &M::occluded_voxels},
                 NamedField{"occlusion_plane_voxels", &M::occlusion_plane_voxels},
                 NamedField{"empty_voxels", &M::empty_voxels},
                 NamedField{"occupied_voxels", &M::occupied_voxels},
                 NamedField{"newly_occupied_voxels", &M::newly_occupied_voxels},
                 NamedField{"occupied_area_m2", &M::occupied_area_m2},
                 NamedField{"occlusion_plane_area_m2", &M::occlusion_plane_area_m2},
                 NamedField{"mean_quality", &M::mean_quality},
                 NamedField{"min_quality", &M::min_quality},
                 NamedField{"points", &M::points},
                 NamedField{"points_outside", &M::points_outside},
                 NamedField{"no_returns", &M::no_returns},
                 NamedField{"invalid", &M::invalid},
                 NamedField{"map_digest", &M::map_digest},
                 NamedField{"history_digest", &M::history_digest}};
};
template <>
struct MessageFields<stop_t> {
  using M = stop_t;
  static constexpr auto list = std::tuple{NamedField{"utime", &M::utime},
                                          NamedField{"run", &M::run},
                                          NamedField{"views", &M::views},
                                          NamedField{"final_attempt", &M::final_attempt},
                                          NamedField{"stop_reason", &M::stop_reason},
                                          NamedField{"detail", &M::detail}};
};
template <>
struct MessageFields<status_t> {
  using M = status_t;
  static constexpr auto list = std::tuple{NamedField{"utime", &M::utime},
                                          NamedField{"run", &M::run},
                                          NamedField{"lost", &M::lost},
                                          NamedField{"repeated", &M::repeated},
                                          NamedField{"foreign", &M::foreign},
                                          NamedField{"refused", &M::refused},
                                          NamedField{"peak_memory_bytes", &M::peak_memory_bytes},
                                          NamedField{"failed", &M::failed},
                                          NamedField{"role", &M::role},
                                          NamedField{"program_version", &M::program_version},
                                          NamedField{"detail", &M::detail}};
};
template <>
struct MessageFields<request_t> {
  using M = request_t;
  static constexpr auto list = std::tuple{NamedField{"utime", &M::utime},
                                          NamedField{"run", &M::run},
                                          NamedField{"view", &M::view},
                                          NamedField{"attempt", &M::attempt},
                                          NamedField{"wanted_channel", &M::wanted_channel},
                                          NamedField{"asker", &M::asker}};
};
template <>
struct MessageFields<timing_t> {
  using M = timing_t;
  static constexpr auto list = std::tuple{
      NamedField{"utime", &M::utime},     NamedField{"durations", &M::durations},
      NamedField{"run", &M::run},         NamedField{"view", &M::view},
      NamedField{"attempt", &M::attempt}, NamedField{"duration_s", &M::duration_s},
      NamedField{"role", &M::role},       NamedField{"duration_names", &M::duration_names}};
};

template <>
struct MessageFields<map_blocks_t> {
  using M = map_blocks_t;
  static constexpr auto list = std::tuple{NamedField{"utime", &M::utime},
                                          NamedField{"blocks", &M::blocks},
                                          NamedField{"surfaces", &M::surfaces},
                                          NamedField{"run", &M::run},
                                          NamedField{"view", &M::view},
                                          NamedField{"since_view", &M::since_view},
                                          NamedField{"part", &M::part},
                                          NamedField{"parts", &M::parts},
                                          NamedField{"voxel_size_m", &M::voxel_size_m},
                                          NamedField{"map_origin_m", &M::map_origin_m},
                                          NamedField{"window_min", &M::window_min},
                                          NamedField{"window_size", &M::window_size},
                                          NamedField{"block_index", &M::block_index},
                                          NamedField{"block_label", &M::block_label},
                                          NamedField{"surface_normal", &M::surface_normal},
                                          NamedField{"surface_quality", &M::surface_quality}};
};

template <>
struct MessageFields<pace_t> {
  using M = pace_t;
  static constexpr std::tuple list = {NamedField{"utime", &M::utime}, NamedField{"run", &M::run},
                                      NamedField{"pace_number", &M::pace_number},
                                      NamedField{"last_view", &M::last_view},
                                      NamedField{"holds_s", &M::holds_s}};
};

template <>
struct MessageFields<parts_request_t> {
  using M = parts_request_t;
  static constexpr auto list = std::tuple{NamedField{"utime", &M::utime},
                                          NamedField{"ranges", &M::ranges},
                                          NamedField{"run", &M::run},
                                          NamedField{"view", &M::view},
                                          NamedField{"attempt", &M::attempt},
                                          NamedField{"first_wanted_part", &M::first_wanted_part},
                                          NamedField{"last_wanted_part", &M::last_wanted_part},
                                          NamedField{"wanted_channel", &M::wanted_channel},
                                          NamedField{"asker", &M::asker}};
};

template <>
struct MessageFields<recorded_t> {
  using M = recorded_t;
  static constexpr std::tuple list = {NamedField{"utime", &M::utime}, NamedField{"run", &M::run},
                                      NamedField{"recorded_views", &M::recorded_views}};
};

namespace message_fields_detail {
template <class T>
concept HasFields = requires {
  MessageFields<T>::list;
};

template <class Message, class F, class Get>
void walk(const std::string& prefix, const Get& get, F& f) {
  std::apply(
      [&](const auto&... field) {
        const auto visit = [&](const auto& one) {
          const auto get_field = [&get, member = one.member ](auto& whole) -> auto& {
            return get(whole).*member;
          };
          using Value = std::remove_cvref_t<decltype(std::declval<Message&>().*(one.member))>;
          const std::string name = prefix + std::string(one.name);
          if constexpr (HasFields<Value>) {
            walk<Value>(name + ".", get_field, f);
          } else {
            f(name, get_field);
          }
        };
        (visit(field), ...);
      },
      MessageFields<Message>::list);
}

template <class Value>
bool same_bits(const Value& a, const Value& b) {
  if constexpr (std::is_floating_point_v<Value>) {
    using Bits = std::conditional_t<sizeof(Value) == 8, std::uint64_t, std::uint32_t>;
    return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
  } else if constexpr (std::is_integral_v<Value> || std::is_same_v<Value, std::string>) {
    return a == b;
  } else {
    if (std::size(a) != std::size(b)) return false;
    for (std::size_t i = 0; i < std::size(a); ++i) {
      if (!same_bits(a[i], b[i])) return false;
    }
    return true;
  }
}
}  // namespace message_fields_detail

/// Calls f(name, get) for every field, where get(message) is a reference to it. The fields of a
/// struct inside the message are named "struct.field".
template <class Message, class F>
void for_each_field(F&& f) {
  message_fields_detail::walk<Message>(
      "", [](auto& message) -> auto& { return message; }, f);
}

/// The names of the fields in which two messages differ, be it in a bit, in order.
template <class Message>
std::vector<std::string> differing_fields(const Message& a, const Message& b) {
  std::vector<std::string> names;
  for_each_field<Message>([&](const std::string& name, const auto& get) {
    if (!message_fields_detail::same_bits(get(a), get(b))) names.push_back(name);
  });
  return names;
}

}  // namespace nextview
