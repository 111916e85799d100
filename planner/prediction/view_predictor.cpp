#include "planner/prediction/view_predictor.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "lcmtypes/parameter_bounds.h"
#include "sensor/sensor_pose.h"

namespace nextview {

PredictionRaster prediction_raster(const SensorGeometry& sensor, const RangeLimits& limits,
                                   const PredictionRays& at_most) {
  bounds::kPredictionRays.require(at_most.columns);
  bounds::kPredictionRays.require(at_most.rows);
  return {make_ray_table(with_raster(sensor, std::min(columns_of(sensor), at_most.columns),
                                     std::min(rows_of(sensor), at_most.rows))),
          limits.max_m};
}

double prediction_reach(const PredictionRaster& raster, double voxel_size_m) {
  return std::clamp(raster.range_max_m / voxel_size_m, 1.0,
                    static_cast<double>(IntegerLine::kMaxSteps));
}

void ViewPredictor::check_count(std::size_t sensors, std::size_t counts) const {
  if (counts == sensors * orientations().size()) return;
  throw std::invalid_argument(std::to_string(counts) + " counts for " + std::to_string(sensors) +
                              " sensors with " + std::to_string(orientations().size()) +
                              " orientations each");
}

void ViewPredictor::predict_all(const KnownSpace& space, std::span<const VoxelIndex> sensors,
                                std::span<ViewCounts> counts) {
  check_count(sensors.size(), counts.size());
  const std::size_t views = orientations().size();
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    predict(space, sensors[i], counts.subspan(i * views, views));
  }
}

void ViewPredictor::check_asked(std::size_t orientations, std::size_t counts) {
  if (counts == orientations) return;
  throw std::invalid_argument(std::to_string(counts) + " counts for " +
                              std::to_string(orientations) + " orientations");
}

void ViewPredictor::look_from(const KnownSpace& space, const VoxelIndex& sensor) {
  from_there_.resize(orientations().size());
  predict(space, sensor, from_there_);
}

void ViewPredictor::count(std::span<const std::size_t> which, std::span<ViewCounts> counts) {
  check_asked(which.size(), counts.size());
  for (std::size_t i = 0; i < which.size(); ++i) counts[i] = from_there_.at(which[i]);
}

RasterViewPredictor::RasterViewPredictor(const PredictionRaster& raster, double voxel_size_m,
                                         std::vector<Orientation> orientations,
                                         bool counts_surfaces)
    : ViewPredictor(std::move(orientations), counts_surfaces), voxel_size_m_(voxel_size_m) {
  if (this->orientations().empty() || raster.rays.pixels() == 0) {
    throw std::invalid_argument("a view predictor needs orientations and rays");
  }
  if (!(voxel_size_m > 0.0) || !(raster.range_max_m > 0.0)) {
    throw std::invalid_argument("a view predictor's voxel size and range must be positive");
  }
}

void RasterViewPredictor::check_arguments(const VoxelMap& map, const VoxelIndex& sensor,
                                          std::size_t counts) const {
  if (!map.contains(sensor)) {
    throw std::invalid_argument("a view cannot be predicted from outside the map's window");
  }
  if (counts != orientations().size() || map.grid().voxel_size_m != voxel_size_m_) {
    throw std::invalid_argument("a view predictor was made for other orientations or voxels");
  }
}

PlainViewPredictor::PlainViewPredictor(const PredictionRaster& raster, double voxel_size_m,
                                       std::vector<Orientation> orientations, bool counts_surfaces)
    : PlainViewPredictor(raster, voxel_size_m, orientations, counts_surfaces,
                         rays_of(raster.rays, orientations)) {}

PlainViewPredictor::PlainViewPredictor(const PredictionRaster& raster, double voxel_size_m,
                                       std::vector<Orientation> orientations, bool counts_surfaces,
                                       std::span<const Eigen::Vector3d> rays)
    : RasterViewPredictor(raster, voxel_size_m, std::move(orientations), counts_surfaces),
      rays_per_view_(raster.rays.pixels()) {
  if (rays.size() != this->orientations().size() * rays_per_view_) {
    throw std::invalid_argument("a view predictor needs as many rays as its raster has");
  }
  const double reach = prediction_reach(raster, voxel_size_m);
  rays_.reserve(rays.size());
  for (const Eigen::Vector3d& ray : rays) {
    rays_.push_back({line_along(VoxelIndex::Zero(), ray, reach), quantise_direction(ray)});
  }
}

std::vector<Eigen::Vector3d> PlainViewPredictor::rays_of(
    const RayTable& rays, std::span<const Orientation> orientations) {
  std::vector<Eigen::Vector3d> directions;
  directions.reserve(orientations.size() * rays.pixels());
  for (const Orientation& orientation : orientations) {
    const Eigen::Matrix3d rotation =
        world_from_sensor_rotation(orientation.pan_rad, orientation.tilt_rad);
    for (int v = 0; v < rays.rows(); ++v) {
      for (int u = 0; u < rays.columns(); ++u) directions.push_back(rotation * rays.ray(u, v));
    }
  }
  return directions;
}

void PlainViewPredictor::predict(const KnownSpace& space, const VoxelIndex& sensor,
                                 std::span<ViewCounts> per_orientation) {
  const VoxelMap& map = space.map();
  check_arguments(map, sensor, per_orientation.size());
  for (std::size_t i = 0; i < per_orientation.size(); ++i) {
    per_orientation[i] = predict_view(map, sensor, rays_of_view(i));
  }
}

void PlainViewPredictor::look_from(const KnownSpace& space, const VoxelIndex& sensor) {
  check_arguments(space.map(), sensor, orientations().size());
  map_ = &space.map();
  sensor_ = sensor;
}

void PlainViewPredictor::count(std::span<const std::size_t> which, std::span<ViewCounts> counts) {
  check_asked(which.size(), counts.size());
  for (std::size_t i = 0; i < which.size(); ++i) {
    counts[i] = predict_view(*map_, sensor_, rays_of_view(which[i]));
  }
}

ViewCounts PlainViewPredictor::predict_view(const VoxelMap& map, const VoxelIndex& sensor,
                                            std::span<const Ray> rays) {
  ViewCounts counts;
  sightings_.clear();
  for (const Ray& ray : rays) {
    IntegerLine line = ray.line;
    line.start = sensor;
    const int last = std::min(line.steps, steps_inside(line, map.window()));
    VoxelIndex voxel = sensor;
    Label met = Label::Empty;
    for (int k = 1; k <= last && met == Label::Empty; ++k) {
      voxel = line.at(k);
      met = map.label(voxel);
    }
    switch (met) {
      case Label::Empty:
        ++counts.open;
        break;
      case Label::Unmarked:
      case Label::Occluded:
        ++counts.unseen;
        break;
      case Label::OcclusionPlane:
        ++counts.occlusion_plane;
        break;
      case Label::Occupied:
        ++counts.occupied;
        if (counts_surfaces()) {
          const SurfaceVoxel* surface = map.surface(voxel);
          const QuantisedDirection normal = surface == nullptr
                                                ? QuantisedDirection{0, 0, 0}
                                                : quantise_direction(surface->mean_normal());
          sightings_.push_back({voxel, quantised_cosine(normal, ray.direction)});
        }
        break;
    }
  }
  if (counts_surfaces()) count_surfaces(map, counts);
  return counts;
}

void PlainViewPredictor::count_surfaces(const VoxelMap& map, ViewCounts& counts) {
  // Sightings of the same voxel side by side, the best first.
  std::sort(sightings_.begin(), sightings_.end(), [&map](const Sighting& a, const Sighting& b) {
    const std::size_t slot_a = map.slot(a.voxel);
    const std::size_t slot_b = map.slot(b.voxel);
    return slot_a != slot_b ? slot_a < slot_b : a.cosine > b.cosine;
  });
  for (std::size_t i = 0; i < sightings_.size(); ++i) {
    const Sighting& sighting = sightings_[i];
    if (i > 0 && sightings_[i - 1].voxel == sighting.voxel) continue;
    ++counts.occupied_voxels;
    const SurfaceVoxel* surface = map.surface(sighting.voxel);
    if (surface == nullptr) continue;
    counts.normals.add(quantise_direction(surface->mean_normal()));
    const int gain = predicted_quality(sighting.cosine) - surface->quality;
    if (gain > 0) {
      ++counts.improved_voxels;
      counts.improvement += gain;
    }
  }
}

}  // namespace nextview
