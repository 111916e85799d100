#pragma once

/// Sines, exponentials and the like for all that a map, a decision or a message depends on. Those
/// of the C library differ in their last bit from processor to processor and from version to
/// version; the bits of these are fixed by IEEE 754, for they are made of operations it rounds one
/// way (double_double.h).
///
/// Results are correctly rounded (to nearest) but where the true one lies within 2^-95 of itself
/// from the middle between two doubles, and where it is no normal number: what tells where the C
/// library, which misses a thousandth of them, came to something else. Arguments and results that
/// are not finite, and signs of zero, are as in ISO C, annex F.
namespace nextview::elementary {

/// Angles in radians. Beyond 2^20 of them they are first reduced by the double next to 2 pi.
double sin(double angle_rad);
double cos(double angle_rad);
double tan(double angle_rad);

double asin(double sine);  ///< NaN outside [-1, 1]
double acos(double cosine);
double atan(double tangent);
/// The angle of (x, y) from the x axis, in [-pi, pi].
double atan2(double y, double x);

double exp(double x);
/// sqrt(x^2 + y^2), for numbers whose squares are normal ones.
double hypot(double x, double y);

}  // namespace nextview::elementary
