#include "scene/standing_places.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/enclosure.h"

namespace nextview {
namespace {

struct Place {
  Eigen::Vector3d position_m;
  double escape;
  double volume_m3;
};

// A window lets a few per cent of the directions out; that is no reason to start elsewhere.
constexpr double kEscapeStep = 0.05;

bool better(const Place& a, const Place& b) {
  const auto escape = [](const Place& place) { return std::floor(place.escape / kEscapeStep); };
  if (escape(a) != escape(b)) return escape(a) < escape(b);
  return a.volume_m3 > b.volume_m3;
}

// The heights of all surfaces that a vertical line meets, from above.
std::vector<double> surfaces_below(const Scene& scene, Eigen::Vector3d from_m, double lowest_m) {
  constexpr double kBeyond_m = 1e-3;  // not to meet the same surface again
  std::vector<double> heights;
  while (from_m.z() > lowest_m) {
    const auto hit = scene.first_hit(from_m, -Eigen::Vector3d::UnitZ());
    if (!hit) break;
    heights.push_back(from_m.z() - double{hit->distance_m});
    from_m.z() = heights.back() - kBeyond_m;
  }
  return heights;
}

// So that what is printed of a place is the place.
double in_whole_centimetres(double length_m) { return std::round(100.0 * length_m) / 100.0; }

// The middles of columns, the scene's middle among them or between them.
std::vector<double> column_middles(double min_m, double max_m, double spacing_m) {
  const auto count = static_cast<int>(std::ceil((max_m - min_m) / spacing_m));
  const double first_m = 0.5 * (min_m + max_m) - 0.5 * (count - 1) * spacing_m;
  std::vector<double> middles;
  middles.reserve(static_cast<std::size_t>(std::max(count, 0)));
  for (int i = 0; i < count; ++i) {
    middles.push_back(in_whole_centimetres(first_m + i * spacing_m));
  }
  return middles;
}

void look_at_column(const Scene& scene, const StandingParameters& parameters, double x_m,
                    double y_m, std::vector<Place>& places) {
  const Eigen::AlignedBox3d bounds = scene.mesh().bounds_m();
  const Eigen::Vector3d top_m(x_m, y_m, bounds.max().z() + 1.0);
  double above_m = std::numeric_limits<double>::infinity();  // the surface over this one
  for (const double floor_m : surfaces_below(scene, top_m, bounds.min().z() - 1.0)) {
    const Eigen::Vector3d position_m(x_m, y_m,
                                     in_whole_centimetres(floor_m + parameters.sensor_height_m));
    const bool stands_on_it = position_m.z() < above_m;
    above_m = floor_m;
    if (!stands_on_it) continue;
    // Not on the roof.
    if (position_m.z() > bounds.max().z() - parameters.clearance_m) continue;
    const double clear_m = scene.clearance_m(position_m, position_m, parameters.clearance_m);
    if (clear_m < parameters.clearance_m) continue;
    places.push_back(
        {position_m, escape_share(scene, position_m), visible_volume_m3(scene, position_m)});
  }
}

}  // namespace

std::vector<Eigen::Vector3d> standing_places(const Scene& scene,
                                             const StandingParameters& parameters,
                                             std::size_t most) {
  constexpr double kApart_m = 1.5;
  const Eigen::AlignedBox3d bounds = scene.mesh().bounds_m();
  const double fewest_apart_m =
      std::sqrt(bounds.sizes().x() * bounds.sizes().y() / parameters.most_columns);
  const double spacing_m = std::max(parameters.spacing_m, fewest_apart_m);
  std::vector<Place> places;
  for (const double y_m : column_middles(bounds.min().y(), bounds.max().y(), spacing_m)) {
    for (const double x_m : column_middles(bounds.min().x(), bounds.max().x(), spacing_m)) {
      look_at_column(scene, parameters, x_m, y_m, places);
    }
  }
  std::stable_sort(places.begin(), places.end(), better);
  std::vector<Eigen::Vector3d> chosen;
  for (const Place& place : places) {
    if (chosen.size() == most) break;
    const bool apart = std::all_of(chosen.begin(), chosen.end(), [&](const Eigen::Vector3d& other) {
      return (other - place.position_m).norm() >= kApart_m;
    });
    if (apart) chosen.push_back(place.position_m);
  }
  return chosen;
}

}  // namespace nextview
