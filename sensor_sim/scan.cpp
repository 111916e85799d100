#include "sensor_sim/scan.h"

#include <cmath>
#include <span>
#include <stdexcept>

#include "lcmtypes/parameter_bounds.h"
#include "sensor_sim/camera_shadow.h"
#include "sensor_sim/measured_range.h"
#include "sensor_sim/strip_caster.h"

namespace nextview {
namespace {

void check(const RayTable& rays, const RangeLimits& limits, const SensorPose& pose,
           double range_noise_m) {
  if (rays.pixels() == 0 || rays.column_cos.size() != rays.column_sin.size() ||
      rays.row_cos.size() != rays.row_sin.size()) {
    throw std::invalid_argument("a scan needs a ray table with as many sines as cosines");
  }
  bounds::kRangeMin.require(limits.min_m);
  bounds::kRangeMax.require(limits.max_m);
  require_below("range_min_m", limits.min_m, "range_max_m", limits.max_m);
  bounds::kRangeNoise.require(range_noise_m);
  if (!pose.position_m.allFinite() || !std::isfinite(pose.pan_rad) ||
      !std::isfinite(pose.tilt_rad)) {
    throw std::invalid_argument("a scan needs a finite pose");
  }
}

// Noise is drawn pixel by pixel and is what takes the time here.
void measure_noisy_ranges(const RangeLimits& limits, double range_noise_m, RandomStream& noise,
                          std::span<float> distance_m) {
  for (float& range_m : distance_m) {
    const double error_m = range_noise_m * noise.gaussian();
    range_m = measured_range(static_cast<double>(range_m) + error_m, limits);
  }
}

}  // namespace

RangeImage scan(const Scene& scene, const RayTable& rays, const RangeLimits& limits,
                const SensorPose& pose, double range_noise_m, RandomStream& noise,
                double baseline_m) {
  check(rays, limits, pose, range_noise_m);
  RangeImage image;
  image.pose = pose;
  image.world_from_sensor = world_from_sensor_rotation(pose.pan_rad, pose.tilt_rad);
  image.position_m = pose.position_m;
  image.rays = rays;
  image.limits = limits;
  image.range_m.reserve(rays.pixels());

  StripCaster caster(scene, image.rays, image.world_from_sensor, image.position_m);
  CameraShadow shadow(scene, image.rays, image.world_from_sensor, image.position_m, baseline_m);
  for (int row = 0; row < rays.rows(); row += StripCaster::kRows) {
    const std::size_t done = image.range_m.size();
    image.range_m.resize(done + caster.pixels(row));
    const std::span<float> strip = std::span(image.range_m).subspan(done);
    caster.cast(row, strip);
    shadow.hide(row, strip);
    if (range_noise_m > 0.0) {
      measure_noisy_ranges(limits, range_noise_m, noise, strip);
    } else {
      measure_ranges(limits, strip);
    }
  }
  return image;
}

}  // namespace nextview
