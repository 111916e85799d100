#include "scoring/surface_samples.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>

namespace nextview {
namespace {

/// The R2 sequence: the plane's golden ratio, in fractions of 2^64 so that it never loses precision
/// however many points are drawn.
class R2Sequence {
 public:
  std::pair<double, double> next() {
    x_ += 0xc13fa9a902a6328full;  // 2^64 / 1.32471795724...
    y_ += 0x91e10da5c79e7b1dull;  // 2^64 / 1.32471795724...^2
    return {static_cast<double>(x_ >> 11) * 0x1.0p-53, static_cast<double>(y_ >> 11) * 0x1.0p-53};
  }

 private:
  std::uint64_t x_ = 0;
  std::uint64_t y_ = 0;
};

std::uint64_t spread_bits(std::uint64_t value) {
  value &= 0x1fffff;
  value = (value | value << 32) & 0x1f00000000ffffull;
  value = (value | value << 16) & 0x1f0000ff0000ffull;
  value = (value | value << 8) & 0x100f00f00f00f00full;
  value = (value | value << 4) & 0x10c30c30c30c30c3ull;
  value = (value | value << 2) & 0x1249249249249249ull;
  return value;
}

/// Morton code of a point's 2 cm cell, counted from the corner of the scene.
std::uint64_t curve_position(const Eigen::Vector3f& point_m, const Eigen::Vector3d& corner_m) {
  constexpr double kCellsPerMetre = 50.0;
  std::uint64_t code = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double cell = (static_cast<double>(point_m[axis]) - corner_m[axis]) * kCellsPerMetre;
    const double clamped = std::clamp(cell, 0.0, 2097151.0);
    code |= spread_bits(static_cast<std::uint64_t>(clamped)) << axis;
  }
  return code;
}

}  // namespace

std::vector<Eigen::Vector3f> sample_surface(const TriangleMesh& mesh, double samples_per_m2,
                                            const std::stop_token& stop) {
  if (!(samples_per_m2 > 0.0) || !std::isfinite(samples_per_m2)) {
    throw std::invalid_argument("surface samples: samples per m2 must be positive and finite");
  }
  std::vector<std::pair<std::uint64_t, Eigen::Vector3f>> samples;
  const Eigen::Vector3d corner_m = mesh.bounds_m().min();
  R2Sequence sequence;
  double owed = 0.0;
  for (std::size_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
    if (stop.stop_requested()) return {};
    const Eigen::Vector3d a = mesh.corner_m(triangle, 0);
    const Eigen::Vector3d ab = mesh.corner_m(triangle, 1) - a;
    const Eigen::Vector3d ac = mesh.corner_m(triangle, 2) - a;
    owed += 0.5 * ab.cross(ac).norm() * samples_per_m2;
    for (; owed >= 1.0; owed -= 1.0) {
      auto [u, v] = sequence.next();
      if (u + v > 1.0) {  // the other half of the parallelogram folds back onto the triangle
        u = 1.0 - u;
        v = 1.0 - v;
      }
      const Eigen::Vector3f point_m = (a + u * ab + v * ac).cast<float>();
      samples.emplace_back(curve_position(point_m, corner_m), point_m);
    }
  }
  std::stable_sort(samples.begin(), samples.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Eigen::Vector3f> points;
  points.reserve(samples.size());
  for (const auto& sample : samples) points.push_back(sample.second);
  return points;
}

}  // namespace nextview
