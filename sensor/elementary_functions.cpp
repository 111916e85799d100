#include "sensor/elementary_functions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "sensor/double_double.h"

#ifdef __FAST_MATH__
#error "Sums in another order, as -ffast-math allows them, give other bits: compile without it"
#endif

namespace nextview::elementary {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr DoubleDouble kOne{1.0, 0.0};
constexpr DoubleDouble kLn2{0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};
constexpr DoubleDouble kPi{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
constexpr DoubleDouble kHalfPi{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
constexpr double kHalfPiBelow = -0x1.f1976b7ed8fbcp-110;  // what is left of it

// Tables of angles and of tangents have a place every 1/32, so that what is left of an argument is
// 1/64 at most and its series are short.
constexpr int kPlaces = 32;

DoubleDouble exact(double x) { return {x, 0.0}; }

/// How far a series is summed: to 2^-63 of what comes of it, mostly in doubles, or to all bits.
enum class Work { Quick, Full };

// What f(Work) comes to, rounded. Where f's quick answer does not tell to which double, it is asked
// for the full one (after Ziv, "Fast evaluation of elementary mathematical functions with correctly
// rounded last bit", ACM TOMS 17, 1991).
template <class Function>
double rounded(const Function& f) {
  const DoubleDouble quick = f(Work::Quick);
  const double error = 0x1p-62 * quick.high;
  const double result = quick.high + (quick.low + error);
  return result == quick.high + (quick.low - error) ? result : f(Work::Full).high;
}

// sum x^i / i! up to this i.
DoubleDouble exponential_series(const DoubleDouble& x, int last) {
  DoubleDouble sum = kOne;
  for (int i = last; i > 0; --i) sum = kOne + x * sum / exact(i);
  return sum;
}

struct SineCosine {
  DoubleDouble sine, cosine;
};

// By their series up to x^last; last is odd.
SineCosine sine_cosine_series(const DoubleDouble& x, int last) {
  const DoubleDouble square = x * x;
  SineCosine sums{kOne, kOne};
  for (int i = last; i > 1; i -= 2) {
    sums.sine = kOne - square * sums.sine / exact(i * (i - 1));
    sums.cosine = kOne - square * sums.cosine / exact((i - 1) * (i - 2));
  }
  return {x * sums.sine, sums.cosine};
}

// Of |x| <= 1/64.
SineCosine sine_cosine_near_zero(const DoubleDouble& x, Work work) {
  if (work == Work::Full) return sine_cosine_series(x, 17);
  const double square = x.high * x.high;
  const double beyond_x =
      x.high * square *
      (-1.0 / 6 + square * (1.0 / 120 + square * (-1.0 / 5040 + square / 362880)));
  const double beyond_one =
      square * (-0.5 + square * (1.0 / 24 + square * (-1.0 / 720 + square / 40320)));
  return {exact_sum_of_ordered(x.high, x.low + beyond_x),
          exact_sum_of_ordered(1.0, beyond_one - x.high * x.low)};
}

// sum (-1)^i x^(2 i + 1) / (2 i + 1) of |x| <= 1/32.
DoubleDouble arctangent_series(const DoubleDouble& x) {
  constexpr int kLast = 21;
  const DoubleDouble square = x * x;
  DoubleDouble sum = kOne / exact(kLast);
  for (int i = kLast - 2; i > 0; i -= 2) sum = kOne / exact(i) - square * sum;
  return x * sum;
}

// Of |x| <= 1/64.
DoubleDouble arctangent_near_zero(const DoubleDouble& x, Work work) {
  if (work == Work::Full) return arctangent_series(x);
  const double square = x.high * x.high;
  const double beyond_x =
      x.high * square *
      (-1.0 / 3 + square * (1.0 / 5 + square * (-1.0 / 7 + square * (1.0 / 9 - square / 11))));
  return exact_sum_of_ordered(x.high, x.low + beyond_x);
}

// Sine and cosine of an angle in [0, pi/4] or a little beyond.
SineCosine sine_cosine_of_eighth(const DoubleDouble& angle, Work work) {
  static const auto table = [] {
    std::array<SineCosine, kPlaces> places;
    for (int i = 0; i < kPlaces; ++i) {
      places[static_cast<std::size_t>(i)] =
          sine_cosine_series(exact(static_cast<double>(i) / kPlaces), 33);
    }
    return places;
  }();
  const double place = std::nearbyint(angle.high * kPlaces);
  const auto& [sine, cosine] = table[static_cast<std::size_t>(place)];
  const SineCosine rest = sine_cosine_near_zero(angle - exact(place / kPlaces), work);
  if (place == 0.0) return rest;
  return {sine * rest.cosine + cosine * rest.sine, cosine * rest.cosine - sine * rest.sine};
}

SineCosine sine_cosine(double angle, Work work) {
  constexpr double kLargest = 0x1p20;
  if (std::abs(angle) > kLargest) angle = std::remainder(angle, kPi.high * 2.0);
  const double quarters = std::nearbyint(angle / kHalfPi.high);
  const DoubleDouble rest = exact(angle) - exact_product(quarters, kHalfPi.high) -
                            exact_product(quarters, kHalfPi.low) - exact(quarters * kHalfPiBelow);
  SineCosine of = sine_cosine_of_eighth(rest.high < 0.0 ? -rest : rest, work);
  if (rest.high < 0.0) of.sine = -of.sine;
  switch (static_cast<int>(quarters) & 3) {
    case 1:
      return {of.cosine, -of.sine};
    case 2:
      return {-of.sine, -of.cosine};
    case 3:
      return {-of.cosine, of.sine};
    default:
      return of;
  }
}

// The angle of (x, y), neither of them negative, one of them near 1.
DoubleDouble angle_in_first_quarter(const DoubleDouble& y, const DoubleDouble& x, Work work) {
  static const auto table = [] {
    std::array<DoubleDouble, kPlaces + 1> places;
    for (int i = 1; i <= kPlaces; ++i) {
      // From the place before by the tangent of a difference.
      const DoubleDouble step =
          exact(kPlaces) / exact(static_cast<double>(kPlaces * kPlaces + i * (i - 1)));
      places[static_cast<std::size_t>(i)] =
          places[static_cast<std::size_t>(i - 1)] + arctangent_series(step);
    }
    return places;
  }();
  if (y.high > x.high) return kHalfPi - angle_in_first_quarter(x, y, work);
  const double place = std::nearbyint(y.high / x.high * kPlaces);
  const DoubleDouble tangent = exact(place / kPlaces);
  return table[static_cast<std::size_t>(place)] +
         arctangent_near_zero((y - tangent * x) / (x + tangent * y), work);
}

double angle_of(const DoubleDouble& y, const DoubleDouble& x) {
  const double angle = rounded([&](Work work) {
    const DoubleDouble of_legs =
        angle_in_first_quarter(y.high < 0.0 ? -y : y, x.high < 0.0 ? -x : x, work);
    return x.high < 0.0 ? kPi - of_legs : of_legs;
  });
  return y.high < 0.0 ? -angle : angle;
}

// sqrt(1 - x^2)
DoubleDouble other_leg(double x) { return sqrt(exact_sum(1.0, -x) * exact_sum(1.0, x)); }

// 2^(i / kPowers), and how e^x is reduced to it.
constexpr int kPowers = 64;

const std::array<DoubleDouble, kPowers>& powers_of_two() {
  static const auto table = [] {
    std::array<DoubleDouble, kPowers> powers;
    for (int i = 0; i < kPowers; ++i) {
      powers[static_cast<std::size_t>(i)] =
          exponential_series(kLn2 * exact(static_cast<double>(i) / kPowers), 32);
    }
    return powers;
  }();
  return table;
}

// power e^rest, rest within 2^-7.5 of 0.
DoubleDouble times_exponential(const DoubleDouble& power, const DoubleDouble& rest, Work work) {
  if (work == Work::Full) return power * exponential_series(rest, 13);
  const double x = rest.high;
  const double beyond_x =
      rest.low +
      x * x *
          (0.5 +
           x * (1.0 / 6 + x * (1.0 / 24 + x * (1.0 / 120 + x * (1.0 / 720 + x * (1.0 / 5040))))));
  const DoubleDouble product = exact_product(power.high, x);
  const DoubleDouble sum = exact_sum_of_ordered(power.high, product.high);
  return exact_sum_of_ordered(
      sum.high, sum.low + (product.low + (power.low + (power.high * beyond_x + power.low * x))));
}

}  // namespace

double sin(double angle_rad) {
  if (!std::isfinite(angle_rad)) return kNan;
  if (angle_rad == 0.0) return angle_rad;
  return rounded([=](Work work) { return sine_cosine(angle_rad, work).sine; });
}

double cos(double angle_rad) {
  if (!std::isfinite(angle_rad)) return kNan;
  return rounded([=](Work work) { return sine_cosine(angle_rad, work).cosine; });
}

double tan(double angle_rad) {
  if (!std::isfinite(angle_rad)) return kNan;
  if (angle_rad == 0.0) return angle_rad;
  return rounded([=](Work work) {
    const SineCosine of = sine_cosine(angle_rad, work);
    return of.sine / of.cosine;
  });
}

double asin(double sine) {
  if (!(std::abs(sine) <= 1.0)) return kNan;
  return sine == 0.0 ? sine : angle_of(exact(sine), other_leg(sine));
}

double acos(double cosine) {
  if (!(std::abs(cosine) <= 1.0)) return kNan;
  return cosine == 1.0 ? 0.0 : angle_of(other_leg(cosine), exact(cosine));
}

double atan(double tangent) { return atan2(tangent, 1.0); }

double atan2(double y, double x) {
  // Multiples of pi/4, which C libraries agree on.
  if (y == 0.0 || x == 0.0 || !std::isfinite(y) || !std::isfinite(x)) return std::atan2(y, x);
  const int exponent = std::ilogb(std::max(std::abs(x), std::abs(y)));
  return angle_of(exact(std::scalbn(y, -exponent)), exact(std::scalbn(x, -exponent)));
}

double exp(double x) {
  constexpr double kLargest = 709.79;
  constexpr double kLeast = -745.2;
  if (std::isnan(x)) return x;
  if (x > kLargest) return kInfinity;
  if (x < kLeast) return 0.0;
  const double place = std::nearbyint(x * (kPowers / std::numbers::ln2));
  const DoubleDouble rest =
      exact(x) - exact_product(place, kLn2.high / kPowers) - exact(place * (kLn2.low / kPowers));
  const int number = static_cast<int>(place);
  const int exponent = number >> 6;
  const DoubleDouble& power = powers_of_two()[static_cast<std::size_t>(number - 64 * exponent)];
  const double mantissa = rounded([&](Work work) { return times_exponential(power, rest, work); });
  return std::scalbn(mantissa, exponent);
}

double hypot(double x, double y) { return sqrt(exact_product(x, x) + exact_product(y, y)).high; }

}  // namespace nextview::elementary
