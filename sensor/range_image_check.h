#pragma once

#include <Eigen/Core>
#include <span>

#include "sensor/sensor_geometry.h"

namespace nextview {

/// What makes a range image right, for its messages and for those who fold it: one answer for both.
/// NaN fails every check but that of the ranges.

/// How far a square sum that should be 1, or a product that should be 0 or 1, may be from it. The
/// sines and rotations of a driver that works in 32-bit floats are right.
constexpr double kUnitTolerance = 1e-6;

/// Whether every sine and cosine belong to one angle. As many of one as of the other.
bool on_unit_circle(std::span<const double> sines, std::span<const double> cosines);

/// Whether a matrix turns and does not stretch, shear or mirror.
bool is_rotation(const Eigen::Matrix3d& matrix);

/// Whether 0 <= minimum < maximum, both finite.
bool are_range_limits(const RangeLimits& limits);

/// Whether no range is negative, -inf included. NaN and +inf are said on purpose (RangeKind), and
/// what lies outside the limits has a meaning too.
bool are_ranges(std::span<const float> range_m);

}  // namespace nextview
