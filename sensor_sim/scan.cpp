#include "sensor_sim/scan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace nextview {
namespace {

// A packet is a tile of neighbouring pixels, whose rays meet much the same boxes of Embree's tree;
// the squarer the tile, the better.
constexpr int kTileColumns = 4;
constexpr int kTileRows = 4;
static_assert(kTileColumns * kTileRows == Scene::kPacketSize);

void check(const RayTable& rays, const RangeLimits& limits, const SensorPose& pose,
           double range_noise_m) {
  if (rays.pixels() == 0 || rays.column_cos.size() != rays.column_sin.size() ||
      rays.row_cos.size() != rays.row_sin.size()) {
    throw std::invalid_argument("a scan needs a ray table with as many sines as cosines");
  }
  if (!(limits.min_m >= 0.0 && limits.min_m <= limits.max_m && std::isfinite(limits.max_m))) {
    throw std::invalid_argument("range limits must be finite with 0 <= minimum <= maximum");
  }
  if (!(range_noise_m >= 0.0 && std::isfinite(range_noise_m))) {
    throw std::invalid_argument("range noise must be a finite standard deviation, 0 or more");
  }
  if (!pose.position_m.allFinite() || !std::isfinite(pose.pan_rad) ||
      !std::isfinite(pose.tilt_rad)) {
    throw std::invalid_argument("a scan needs a finite pose");
  }
}

// The rays of all pixels in world directions, tile by tile along a strip of kTileRows rows. Where
// a tile reaches over the image's edge, the pixels of the edge are cast again.
class StripCaster {
 public:
  StripCaster(const Scene& scene, const RayTable& rays, const Eigen::Matrix3d& world_from_sensor,
              const Eigen::Vector3d& position_m)
      : scene_(scene),
        rays_(rays),
        world_from_sensor_(world_from_sensor),
        origin_m_(position_m.cast<float>()),
        directions_(static_cast<std::size_t>((rays.columns() + kTileColumns - 1) / kTileColumns)),
        distances_(directions_.size()),
        column_sin_(rays.column_sin),
        column_cos_(rays.column_cos) {
    column_sin_.resize(directions_.size() * kTileColumns, column_sin_.back());
    column_cos_.resize(directions_.size() * kTileColumns, column_cos_.back());
  }

  // Writes the distances of rows first_row .. first_row + kTileRows - 1 into a whole image.
  void cast(int first_row, std::vector<float>& distance_m) {
    for (int j = 0; j < kTileRows; ++j) {
      fill_row(std::min(first_row + j, rays_.rows() - 1), j);
    }
    scene_.cast(origin_m_, directions_, distances_);
    for (int j = 0; j < kTileRows && first_row + j < rays_.rows(); ++j) {
      const auto row = static_cast<std::size_t>(first_row + j);
      const auto columns = static_cast<std::size_t>(rays_.columns());
      for (std::size_t u = 0; u < columns; ++u) {
        distance_m[row * columns + u] = distances_[u / kTileColumns].m[lane(u, j)];
      }
    }
  }

 private:
  static std::size_t lane(std::size_t u, int j) {
    return static_cast<std::size_t>(j) * kTileColumns + u % kTileColumns;
  }

  // world_from_sensor · n_uv (eq. 1 and 5), the part common to a row taken out:
  // n_uv = cos(alpha_u) Rx(beta_v) y - sin(alpha_u) x.
  void fill_row(int v, int j) {
    const auto row = static_cast<std::size_t>(v);
    const Eigen::Vector3d row_axis = rays_.row_cos[row] * world_from_sensor_.col(1) +
                                     rays_.row_sin[row] * world_from_sensor_.col(2);
    const Eigen::Vector3d right = world_from_sensor_.col(0);
    for (std::size_t tile = 0; tile < directions_.size(); ++tile) {
      const double* sine = &column_sin_[tile * kTileColumns];
      const double* cosine = &column_cos_[tile * kTileColumns];
      const auto project = [&](int axis, float* lanes) {
        for (std::size_t i = 0; i < kTileColumns; ++i) {
          lanes[i] = static_cast<float>(cosine[i] * row_axis[axis] - sine[i] * right[axis]);
        }
      };
      const std::size_t first_lane = lane(0, j);
      project(0, &directions_[tile].x[first_lane]);
      project(1, &directions_[tile].y[first_lane]);
      project(2, &directions_[tile].z[first_lane]);
    }
  }

  const Scene& scene_;
  const RayTable& rays_;
  const Eigen::Matrix3d& world_from_sensor_;
  Eigen::Vector3f origin_m_;
  std::vector<Scene::Directions> directions_;
  std::vector<Scene::Distances> distances_;
  std::vector<double> column_sin_;  // of the ray table, the last one repeated to fill the last tile
  std::vector<double> column_cos_;
};

float measured_range(double distance_m, const RangeLimits& limits) {
  if (distance_m < limits.min_m) {
    return std::numeric_limits<float>::quiet_NaN();
  }
  if (distance_m > limits.max_m) {
    return std::numeric_limits<float>::infinity();
  }
  return quantise_range(distance_m);
}

constexpr int kSpreadDirections = 2048;

// Evenly spread over the sphere: a Fibonacci spiral.
std::vector<Scene::Directions> spread_directions() {
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<Scene::Directions> directions(kSpreadDirections / Scene::kPacketSize);
  for (std::size_t i = 0; i < kSpreadDirections; ++i) {
    const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / kSpreadDirections;
    const double radius = std::sqrt(1.0 - z * z);
    const double angle = golden_angle * static_cast<double>(i);
    Scene::Directions& packet = directions[i / Scene::kPacketSize];
    packet.x[i % Scene::kPacketSize] = static_cast<float>(radius * std::cos(angle));
    packet.y[i % Scene::kPacketSize] = static_cast<float>(radius * std::sin(angle));
    packet.z[i % Scene::kPacketSize] = static_cast<float>(z);
  }
  return directions;
}

std::vector<Scene::Distances> cast_all(const Scene& scene, const Eigen::Vector3d& position_m,
                                       const std::vector<Scene::Directions>& directions) {
  std::vector<Scene::Distances> distances(directions.size());
  scene.cast(position_m.cast<float>(), directions, distances);
  return distances;
}

// How far it is from a position inside a box to its side.
double distance_to_side(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& position_m,
                        const Eigen::Vector3d& direction) {
  double distance = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] != 0.0) {
      const double side = direction[axis] > 0.0 ? box.max()[axis] : box.min()[axis];
      distance = std::min(distance, (side - position_m[axis]) / direction[axis]);
    }
  }
  return std::max(distance, 0.0);
}

}  // namespace

RangeImage scan(const Scene& scene, const RayTable& rays, const RangeLimits& limits,
                const SensorPose& pose, double range_noise_m, RandomStream& noise) {
  check(rays, limits, pose, range_noise_m);
  RangeImage image;
  image.pose = pose;
  image.world_from_sensor = world_from_sensor_rotation(pose.pan_rad, pose.tilt_rad);
  image.position_m = pose.position_m;
  image.rays = rays;
  image.limits = limits;
  image.range_m.resize(rays.pixels());

  StripCaster caster(scene, image.rays, image.world_from_sensor, image.position_m);
  for (int row = 0; row < rays.rows(); row += kTileRows) {
    caster.cast(row, image.range_m);
  }
  for (float& range_m : image.range_m) {
    const double error_m = range_noise_m > 0.0 ? range_noise_m * noise.gaussian() : 0.0;
    range_m = measured_range(static_cast<double>(range_m) + error_m, limits);
  }
  return image;
}

double escape_share(const Scene& scene, const Eigen::Vector3d& position_m) {
  int escaped = 0;
  for (const Scene::Distances& packet : cast_all(scene, position_m, spread_directions())) {
    for (const float distance_m : packet.m) {
      escaped += std::isinf(distance_m) ? 1 : 0;
    }
  }
  return static_cast<double>(escaped) / kSpreadDirections;
}

double visible_volume_m3(const Scene& scene, const Eigen::Vector3d& position_m) {
  const std::vector<Scene::Directions> directions = spread_directions();
  const std::vector<Scene::Distances> distances = cast_all(scene, position_m, directions);
  const Eigen::AlignedBox3d bounds = scene.mesh().bounds_m();
  double cubes = 0.0;
  for (std::size_t i = 0; i < kSpreadDirections; ++i) {
    const std::size_t lane = i % Scene::kPacketSize;
    const Scene::Directions& packet = directions[i / Scene::kPacketSize];
    const Eigen::Vector3f direction(packet.x[lane], packet.y[lane], packet.z[lane]);
    const auto to_surface_m = static_cast<double>(distances[i / Scene::kPacketSize].m[lane]);
    const double seen_m =
        std::min(to_surface_m, distance_to_side(bounds, position_m, direction.cast<double>()));
    cubes += seen_m * seen_m * seen_m;
  }
  return 4.0 / 3.0 * std::numbers::pi * cubes / kSpreadDirections;
}

}  // namespace nextview
