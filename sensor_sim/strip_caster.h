#pragma once

#include <span>
#include <vector>

#include "scene/scene.h"
#include "sensor/ray_table.h"

namespace nextview {

/// Casts the rays of an image strip by strip: kRows rows at a time, from the top. A packet is a
/// tile of a strip, so that its rays meet much the same boxes of the scene's tree; the squarer the
/// tile, the better. Where a tile reaches over the image's edge, the pixels of the edge are cast
/// again.
class StripCaster {
 public:
  static constexpr int kRows = 4;

  /// @param scene and rays must live as long as this
  StripCaster(const Scene& scene, const RayTable& rays, const Eigen::Matrix3d& world_from_sensor,
              const Eigen::Vector3d& position_m);

  /// How many pixels the strip has that begins with a row.
  std::size_t pixels(int first_row) const;

  /// Distances along the rays of a strip, row by row; +inf where nothing is met.
  /// @param distance_m of size pixels(first_row)
  void cast(int first_row, std::span<float> distance_m);

 private:
  int rows(int first_row) const;

  const Scene& scene_;
  const RayTable& rays_;
  Eigen::Matrix3d world_from_lines_;
  Eigen::Vector3f origin_m_;
  std::vector<double> column_sin_;  // of the ray table, the last one repeated to fill the last tile
  std::vector<double> column_cos_;
  std::vector<Scene::Directions> directions_;  // of the tiles of a strip
  std::vector<Scene::Distances> distances_;
};

}  // namespace nextview
