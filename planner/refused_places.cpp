#include "planner/refused_places.h"

#include <algorithm>

namespace nextview {

void RefusedPlaces::add(ClearSpace& space, std::span<const Eigen::Vector3d> way_m,
                        std::size_t in_this_view) {
  const auto keep_out_of = [&](const Eigen::Vector3d& position_m) {
    const double away_m = (position_m - way_m.front()).norm();
    places_.push_back({position_m, std::min(space.parameters().clearance_m, 0.5 * away_m)});
    space.block(places_.back().center_m, places_.back().radius_m);
  };
  keep_out_of(way_m.back());
  if (in_this_view < 2) return;
  for (const Eigen::Vector3d& corner_m : way_m.subspan(1, way_m.size() - 2)) keep_out_of(corner_m);
}

void RefusedPlaces::forget_near(ClearSpace& space, const VoxelMap& map,
                                std::span<const std::uint32_t> changed_slots) {
  if (places_.empty()) return;
  const double margin_m = space.parameters().clearance_m + map.grid().voxel_size_m;
  const auto known_better = [&](const Place& place) {
    return std::ranges::any_of(changed_slots, [&](std::uint32_t slot) {
      const Eigen::Vector3d changed_m = map.grid().center_m(map.index_of_slot(slot));
      return (changed_m - place.center_m).norm() < margin_m;
    });
  };
  if (std::erase_if(places_, known_better) == 0) return;
  space.unblock_all();
  for (const Place& place : places_) space.block(place.center_m, place.radius_m);
}

}  // namespace nextview
