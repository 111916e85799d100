#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "mapper/voxel_map.h"
#include "planner/clear_space.h"

namespace nextview {

/// Where the base would not go, as far as is known. A refusal says that something is too near on
/// the way and not where: most likely at the goal, and when another goal of the same view is
/// refused too, at a corner of the way, where ways pass obstacles. The robot keeps out of a ball
/// around each, of the clearance's radius or half the distance to where it stood, until something
/// becomes known there: from the same knowledge no goal is tried twice.
class RefusedPlaces {
 public:
  /// @param way_m the refused goal's waypoints, the present position first
  /// @param in_this_view how many goals of the view have been refused, this one included
  void add(ClearSpace& space, std::span<const Eigen::Vector3d> way_m, std::size_t in_this_view);

  /// To be called after ClearSpace::update, with the slots it returned.
  void forget_near(ClearSpace& space, const VoxelMap& map,
                   std::span<const std::uint32_t> changed_slots);

  bool empty() const { return places_.empty(); }
  void clear() { places_.clear(); }

 private:
  struct Place {
    Eigen::Vector3d center_m;
    double radius_m;
  };
  std::vector<Place> places_;
};

}  // namespace nextview
