#include "scene/enclosure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace nextview {
namespace {

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
