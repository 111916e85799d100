// Normals estimated from range images of worlds whose normals are known.
#include "mapper/normals.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <numbers>

#include "mapper/reference_map_update.h"
#include "tests/mapper/analytic_world.h"

namespace nextview {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

Eigen::Vector3d normal_at(const NormalRow& row, int u) {
  const auto i = static_cast<std::size_t>(u);
  return Eigen::Vector3d(row.x[i], row.y[i], row.z[i]) / SurfaceVoxel::kNormalUnit;
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// The worst and the mean over the pixels of an image.
struct NormalErrors {
  double worst_rad = 0.0;
  double sum_rad = 0.0;
  std::int64_t with_normal = 0;
  std::int64_t without = 0;

  void add(double error_rad) {
    worst_rad = std::max(worst_rad, error_rad);
    sum_rad += error_rad;
    ++with_normal;
  }
  double mean_rad() const { return sum_rad / static_cast<double>(with_normal); }
  double share() const {
    return static_cast<double>(with_normal) / static_cast<double>(with_normal + without);
  }
};

// Calls judge(u, v, point, normal) for every pixel that hit something; normal is zero without one.
template <typename Judge>
void for_each_normal(const RangeImage& image, Judge judge) {
  NormalEstimator estimator;
  estimator.prepare(image);
  NormalRow row;
  for (int v = 0; v < image.rays.rows(); ++v) {
    estimator.row(v, row);
    for (int u = 0; u < image.rays.columns(); ++u) {
      const auto pixel = static_cast<std::size_t>(v * image.rays.columns() + u);
      const double range_m = image.range_m[pixel];
      if (!std::isfinite(range_m)) continue;
      const Eigen::Vector3d ray = image.world_from_sensor * image.rays.ray(u, v);
      judge(u, v, Eigen::Vector3d(image.position_m + range_m * ray), normal_at(row, u));
    }
  }
}

RayTable sensor_of(int which) {
  switch (which) {
    case 0:
      return make_ray_table(TiltedLineScan::paper());
    case 1:
      return make_ray_table(TiltedLineScan::with_aperture(128, 64, std::numbers::pi / 3));
    case 2:
      return make_ray_table(TiltedLineScan::with_aperture(200, 90, std::numbers::pi / 3));
    case 3:
      return make_ray_table(TiltedLineScan::with_aperture(90, 45, 1.3));
    case 4:
      return make_ray_table(SphericalScanner{240, 70, 2.0 * std::numbers::pi, 100.0 * kDegree});
    case 5:
      return make_ray_table(LineStriper{100, 90, 1.0, 0.8, 0.0});
    default:
      return make_ray_table(TiltedLineScan::with_aperture(512, 256, std::numbers::pi / 3));
  }
}

SensorPose random_pose(RandomStream& random) {
  SensorPose pose;
  for (int axis = 0; axis < 3; ++axis) pose.position_m[axis] = uniform(random, -5.0, 5.0);
  pose.pan_rad = uniform(random, -std::numbers::pi, std::numbers::pi);
  pose.tilt_rad = uniform(random, -0.5, 0.5) * std::numbers::pi;
  return pose;
}

Eigen::Vector3d random_direction(RandomStream& random) {
  const double z = uniform(random, -1.0, 1.0);
  const double angle = uniform(random, 0.0, 2.0 * std::numbers::pi);
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

TEST(Normals, AreRightToTwoDegreesOnEveryPixelOfAPlane) {
  NormalErrors errors;
  for (int n = 0; n < 250; ++n) {
    RandomStream random(n, 1, 1, RandomPurpose::RangeNoise);
    const RayTable rays = sensor_of(n % 25 == 0 ? 6 : n % 6);
    const SensorPose pose = random_pose(random);
    const Eigen::Vector3d normal = random_direction(random);
    // So that the nearest pixels are at about 0.4 m and the farthest at 10 m.
    const double distance_m = std::exp(uniform(random, std::log(0.08), std::log(10.0)));
    AnalyticWorld world;
    world.planes.push_back({normal, normal.dot(pose.position_m) - distance_m});
    const RangeImage image = scan_world(world, rays, {0.4, 10.0}, pose);
    for_each_normal(image, [&](int, int, const Eigen::Vector3d& p, const Eigen::Vector3d& found) {
      const double incidence = std::acos(std::min(1.0, distance_m / (p - pose.position_m).norm()));
      if (incidence > 80.0 * kDegree) return;
      if (found.isZero()) {
        ++errors.without;
        return;
      }
      errors.add(angle_between(found, normal));
    });
  }
  EXPECT_LT(errors.worst_rad, 2.0 * kDegree);
  EXPECT_GT(errors.with_normal, 500'000);
  EXPECT_GT(errors.share(), 0.98);
  std::cout << errors.with_normal << " normals, worst " << errors.worst_rad / kDegree
            << " deg, mean " << errors.mean_rad() / kDegree << " deg, share " << errors.share()
            << '\n';
}

// A world of planes seen in an image: for every pixel the index of the plane it shows.
struct SeenPlanes {
  std::vector<int> plane;  ///< by pixel; -1 where nothing was hit
  std::vector<Eigen::Vector3d> normals;

  // Whether a pixel is more than a pixel away from every edge, and the plane goes on for more than
  // two strides to at least one side along its row and along its column. (In a strip narrower than
  // that nothing confirms a slope.)
  bool judgeable(const RayTable& rays, int u, int v) const {
    const auto reach = [&](int step_u, int step_v) {
      int steps = 0;
      int column = u + step_u;
      int row = v + step_v;
      const int here = plane[static_cast<std::size_t>(v * rays.columns() + u)];
      while (column >= 0 && column < rays.columns() && row >= 0 && row < rays.rows()) {
        if (plane[static_cast<std::size_t>(row * rays.columns() + column)] != here) return steps;
        column += step_u;
        row += step_v;
        ++steps;
      }
      return steps + 2;  // the border of the image is no edge
    };
    const int column_stride = normal_stride(rays.column_sin, rays.column_cos);
    const int row_stride = normal_stride(rays.row_sin, rays.row_cos);
    const auto [left, right] = std::minmax({reach(-1, 0), reach(1, 0)});
    const auto [up, down] = std::minmax({reach(0, -1), reach(0, 1)});
    return left >= 2 && up >= 2 && right > 2 * column_stride + 1 && down > 2 * row_stride + 1;
  }
};

// The faces of the axis-aligned boxes of a world, as the pixels of an image show them.
SeenPlanes faces_seen(const AnalyticWorld& world, const RangeImage& image) {
  SeenPlanes seen;
  std::vector<double> offsets_m;
  for (const AnalyticWorld::Box& box : world.boxes) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double wall_m : {box.min_m[axis], box.max_m[axis]}) {
        seen.normals.push_back(Eigen::Vector3d::Unit(axis));
        offsets_m.push_back(wall_m);
      }
    }
  }
  for (int v = 0; v < image.rays.rows(); ++v) {
    for (int u = 0; u < image.rays.columns(); ++u) {
      const Eigen::Vector3d ray = image.world_from_sensor * image.rays.ray(u, v);
      const double range_m = world.distance_m(image.position_m, ray);
      const Eigen::Vector3d p = image.position_m + range_m * ray;
      int nearest = -1;
      for (std::size_t n = 0; n < offsets_m.size(); ++n) {
        const AnalyticWorld::Box& box = world.boxes[n / 6];
        const double slack = 1e-6;
        const bool on_box = (p.array() >= box.min_m.array() - slack).all() &&
                            (p.array() <= box.max_m.array() + slack).all();
        if (on_box && std::abs(seen.normals[n].dot(p) - offsets_m[n]) < 1e-9) {
          nearest = static_cast<int>(n);
        }
      }
      seen.plane.push_back(nearest);
    }
  }
  return seen;
}

struct EdgeErrors {
  std::int64_t judged = 0;
  std::int64_t judgeable = 0;
  std::int64_t wrong = 0;
  std::int64_t wrong_judgeable = 0;
};

void judge_edges(const AnalyticWorld& world, const RangeImage& image, EdgeErrors& errors) {
  const SeenPlanes seen = faces_seen(world, image);
  for_each_normal(image, [&](int u, int v, const Eigen::Vector3d& p, const Eigen::Vector3d& found) {
    const int plane = seen.plane[static_cast<std::size_t>(v * image.rays.columns() + u)];
    if (plane < 0 || found.isZero()) return;
    Eigen::Vector3d normal = seen.normals[static_cast<std::size_t>(plane)];
    const Eigen::Vector3d to_sensor = (image.position_m - p).normalized();
    if (normal.dot(to_sensor) < 0.0) normal = -normal;
    if (normal.dot(to_sensor) < std::cos(80.0 * kDegree)) return;
    const bool judgeable = seen.judgeable(image.rays, u, v);
    const bool wrong = angle_between(found, normal) > 2.0 * kDegree;
    ++errors.judged;
    errors.judgeable += judgeable;
    errors.wrong += wrong;
    errors.wrong_judgeable += wrong && judgeable;
  });
}

// Rooms from inside: walls that meet in creases and corners.
TEST(Normals, AreRightToTwoDegreesUpToTheCreasesOfARoom) {
  EdgeErrors errors;
  for (int n = 0; n < 75; ++n) {
    RandomStream random(n, 2, 1, RandomPurpose::RangeNoise);
    SensorPose pose = random_pose(random);
    pose.position_m = {uniform(random, 0.6, 3.4), uniform(random, 0.6, 2.4),
                       uniform(random, 0.6, 2.4)};
    AnalyticWorld world;
    world.boxes.push_back({Eigen::Vector3d::Zero(), {4.0, 3.0, 3.0}});
    judge_edges(world, scan_world(world, sensor_of(n % 25 == 0 ? 6 : n % 6), {0.4, 10.0}, pose),
                errors);
  }
  EXPECT_EQ(errors.wrong_judgeable, 0);
  EXPECT_GT(errors.judgeable, 500'000);
  EXPECT_LT(errors.wrong, errors.judged / 1000);
  std::cout << errors.judged << " normals, " << errors.wrong << " wrong, " << errors.judgeable
            << " judgeable, " << errors.wrong_judgeable << " of them wrong\n";
}

// Boxes in a room: jumps in depth as well.
TEST(Normals, AreRightToTwoDegreesUpToTheEdgesOfABox) {
  EdgeErrors errors;
  for (int n = 0; n < 75; ++n) {
    RandomStream random(n, 3, 1, RandomPurpose::RangeNoise);
    SensorPose pose = random_pose(random);
    pose.position_m = {2.0, 1.5, uniform(random, 0.6, 2.4)};
    AnalyticWorld world;
    world.boxes.push_back({Eigen::Vector3d::Zero(), {4.0, 3.0, 3.0}});
    const Eigen::Vector3d view = viewing_direction(pose.pan_rad, pose.tilt_rad);
    const Eigen::Vector3d corner =
        pose.position_m + uniform(random, 0.8, 1.0) * view - Eigen::Vector3d::Constant(0.2);
    world.boxes.push_back({corner, corner + Eigen::Vector3d::Constant(0.4)});
    judge_edges(world, scan_world(world, sensor_of(n % 25 == 0 ? 6 : n % 6), {0.4, 10.0}, pose),
                errors);
  }
  EXPECT_LE(errors.wrong_judgeable, errors.judgeable / 1'000'000);
  EXPECT_GT(errors.judgeable, 500'000);
  EXPECT_LT(errors.wrong, errors.judged / 100);
  std::cout << errors.judged << " normals, " << errors.wrong << " wrong, " << errors.judgeable
            << " judgeable, " << errors.wrong_judgeable << " of them wrong\n";
}

// A wall 2 m away with 1 cm of noise on the ranges: over 0.9 degrees, 3 cm, single normals are off
// by many degrees, but their mean is not, and this is what a voxel keeps.
TEST(Normals, HaveASensibleMeanUnderNoise) {
  for (const double incidence_deg : {0.0, 30.0, 60.0}) {
    for (const int sensor : {0, 4}) {
      RandomStream random(sensor, 4, 1, RandomPurpose::RangeNoise);
      const Eigen::Vector3d normal(std::sin(incidence_deg * kDegree),
                                   -std::cos(incidence_deg * kDegree), 0.0);
      AnalyticWorld world;
      world.planes.push_back({normal, -2.0 * std::cos(incidence_deg * kDegree)});
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      NormalErrors errors;
      const auto rays = make_ray_table(
          TiltedLineScan::with_aperture(sensor == 0 ? 64 : 512, sensor == 0 ? 30 : 256, 0.5));
      const RangeImage image = scan_world(world, rays, {0.05, 30.0}, SensorPose(), 0.01, &random);
      for_each_normal(image, [&](int, int, const Eigen::Vector3d&, const Eigen::Vector3d& found) {
        if (found.isZero()) return;
        sum += found;
        errors.add(angle_between(found, normal));
      });
      const double mean_error_deg = angle_between(sum, normal) / kDegree;
      EXPECT_LT(mean_error_deg, 3.0);
      std::cout << rays.columns() << " columns, incidence " << incidence_deg
                << ": single normals off by " << errors.mean_rad() / kDegree
                << " deg, their mean by " << mean_error_deg << " deg\n";
    }
  }
}

}  // namespace
}  // namespace nextview
