#pragma once

#include <span>
#include <vector>

#include "scene/scene.h"
#include "sensor/ray_table.h"

namespace nextview {

/// What the camera of a line striper does not see (line_striper.h): it stands beside the light, so
/// a surface may be lit and yet hidden from it by a nearer one.
class CameraShadow {
 public:
  /// @param baseline_m how far the camera stands to the right of the light, along the sensor's x
  ///        axis; with 0 it sees all that is lit
  /// @param scene and rays must live as long as this
  CameraShadow(const Scene& scene, const RayTable& rays, const Eigen::Matrix3d& world_from_sensor,
               const Eigen::Vector3d& position_m, double baseline_m);

  /// Makes NaN of the distances along the rays of rows first_row, first_row + 1, ... whose points
  /// the camera does not see. Those that are not finite stay.
  void hide(int first_row, std::span<float> distance_m);

 private:
  const Scene& scene_;
  const RayTable& rays_;
  Eigen::Matrix3d world_from_lines_;
  Eigen::Vector3d light_m_;
  Eigen::Vector3d camera_m_;
  bool hides_;
  std::vector<Scene::Directions> directions_;
  std::vector<Scene::Distances> distances_;
  std::vector<float> reach_m_;  // from the camera to each point
};

}  // namespace nextview
