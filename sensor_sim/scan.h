#pragma once

#include "scene/scene.h"
#include "sensor/random_stream.h"
#include "sensor/range_image.h"

namespace nextview {

/// The range image of a scene from a pose (paper eq. 1 and 5).
///
/// Gaussian noise of the given standard deviation is added to every distance before the limits are
/// applied: below limits.min_m the range is NaN (invalid), above limits.max_m or where nothing is
/// met +inf (no return). Ranges are rounded by quantise_range. One noise number is drawn for every
/// pixel in the order of pixels, whatever it meets; none when range_noise_m is 0.
/// @param baseline_m of a line striper: what its camera does not see is NaN (camera_shadow.h)
/// @throws std::invalid_argument for limits or noise that no sensor has (parameter_bounds.h), an
/// empty ray table, or a pose that is not finite
RangeImage scan(const Scene& scene, const RayTable& rays, const RangeLimits& limits,
                const SensorPose& pose, double range_noise_m, RandomStream& noise,
                double baseline_m = 0.0);

}  // namespace nextview
