#pragma once

#include "sensor_sim/random_stream.h"
#include "sensor_sim/range_image.h"
#include "sensor_sim/scene.h"

namespace nextview {

/// The range image of a scene from a pose (paper eq. 1 and 5).
///
/// Gaussian noise of the given standard deviation is added to every distance before the limits are
/// applied: below limits.min_m the range is NaN (invalid), above limits.max_m or where nothing is
/// met +inf (no return). Ranges are rounded by quantise_range. One noise number is drawn for every
/// pixel in the order of pixels, whatever it meets; none when range_noise_m is 0.
/// @throws std::invalid_argument for limits or noise that are negative or not finite, min above
/// max, an empty ray table, or a pose that is not finite
RangeImage scan(const Scene& scene, const RayTable& rays, const RangeLimits& limits,
                const SensorPose& pose, double range_noise_m, RandomStream& noise);

/// Share in [0, 1] of a fixed set of evenly spread directions that meet no surface: 0 in a closed
/// scene.
double escape_share(const Scene& scene, const Eigen::Vector3d& position_m);

/// Volume seen from a position inside the scene's bounds, in the same directions and up to the
/// bounds where they meet no surface. From inside a piece of furniture it is very small, whether
/// the furniture has a bottom or not.
double visible_volume_m3(const Scene& scene, const Eigen::Vector3d& position_m);

}  // namespace nextview
