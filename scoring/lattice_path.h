#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace nextview {

/// Lengths of ways along a lattice of positions, from one to any of its 26 neighbours that is
/// there.
class LatticePaths {
 public:
  /// @param positions_m multiples of the spacing
  LatticePaths(const std::vector<Eigen::Vector3d>& positions_m, double spacing_m);

  /// The shortest way between two positions; they begin and end at the lattice point nearest by, up
  /// to which the way is straight. Infinite when there is none.
  double length_m(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) const;

 private:
  std::uint32_t nearest(const Eigen::Vector3d& position_m) const;

  std::vector<Eigen::Vector3i> nodes_;
  std::unordered_map<std::uint64_t, std::uint32_t> number_of_;  ///< looked up only
  double spacing_m_;
};

}  // namespace nextview
