#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "mapper/voxel_map.h"
#include "planner/prediction/view_predictor.h"
#include "sensor/sensor_pose.h"

namespace nextview {

/// What a ray of a predicted view meets first (P15).
enum class Meeting : std::uint8_t { Occupied, OcclusionPlane, Unseen, Open };

inline Meeting meeting_of(Label label) {
  switch (label) {
    case Label::Unmarked:
    case Label::Occluded:
      return Meeting::Unseen;
    case Label::OcclusionPlane:
      return Meeting::OcclusionPlane;
    case Label::Empty:
      return Meeting::Open;
    case Label::Occupied:
      return Meeting::Occupied;
  }
  throw std::logic_error("a label that does not exist");
}

/// World directions of all rays, by orientation and then by pixel.
inline std::vector<Eigen::Vector3d> world_rays(const PredictionRaster& raster,
                                               const std::vector<Orientation>& orientations) {
  std::vector<Eigen::Vector3d> rays;
  for (const Orientation& orientation : orientations) {
    const Eigen::Matrix3d rotation =
        world_from_sensor_rotation(orientation.pan_rad, orientation.tilt_rad);
    for (int v = 0; v < raster.rays.rows(); ++v) {
      for (int u = 0; u < raster.rays.columns(); ++u)
        rays.push_back(rotation * raster.rays.ray(u, v));
    }
  }
  return rays;
}

/// A view predictor over any structure that can say what one ray meets:
///   Meeting cast(const VoxelIndex& sensor, const Eigen::Vector3d& direction) const
/// So every structure does the same work around its cast: the same rays, counted into the same
/// shares. It holds the labels itself; the map it is asked about is not looked at.
template <class Caster>
class CastingViewPredictor : public ViewPredictor {
 public:
  CastingViewPredictor(const Caster& caster, const PredictionRaster& raster,
                       std::vector<Orientation> orientations)
      : ViewPredictor(std::move(orientations), false),
        caster_(caster),
        rays_(world_rays(raster, this->orientations())),
        rays_per_view_(raster.rays.pixels()) {}

  void predict(const KnownSpace&, const VoxelIndex& sensor,
               std::span<ViewCounts> per_orientation) override {
    for (std::size_t i = 0; i < per_orientation.size(); ++i) {
      std::int64_t met[4] = {0, 0, 0, 0};
      for (std::size_t ray = i * rays_per_view_; ray < (i + 1) * rays_per_view_; ++ray) {
        ++met[static_cast<std::size_t>(caster_.cast(sensor, rays_[ray]))];
      }
      per_orientation[i] = {met[0], met[1], met[2], met[3], 0, 0, 0};
    }
  }

 private:
  const Caster& caster_;
  std::vector<Eigen::Vector3d> rays_;
  std::size_t rays_per_view_;
};

}  // namespace nextview
