#pragma once

#include <cmath>

namespace nextview {

/// A number as the sum of two doubles, high being the sum rounded to a double: some 106 bits. Made
/// of additions, products, quotients and square roots of doubles, each of which IEEE 754 rounds one
/// way, so that every processor and compiler comes to the same bits (with -ffp-contract=off). After
/// Dekker, "A floating-point technique for extending the available precision", Numerische
/// Mathematik 18, 1971, and Joldes, Muller and Popescu, "Tight and rigorous error bounds for basic
/// building blocks of double-word arithmetic", ACM TOMS 44, 2017. Relative errors are a few 2^-106,
/// unless something overflows or underflows.
struct DoubleDouble {
  double high = 0.0;
  double low = 0.0;
};

/// a + b, exactly.
inline DoubleDouble exact_sum(double a, double b) {
  const double sum = a + b;
  const double part_of_b = sum - a;
  return {sum, (a - (sum - part_of_b)) + (b - part_of_b)};
}

/// a + b, exactly, where |a| >= |b| or a is 0.
inline DoubleDouble exact_sum_of_ordered(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// a b, exactly.
inline DoubleDouble exact_product(double a, double b) {
  constexpr double kSplitter = 0x1p27 + 1.0;
  const auto upper_half = [](double x) {
    const double scaled = kSplitter * x;
    return scaled - (scaled - x);
  };
  const double product = a * b;
  const double a1 = upper_half(a);
  const double b1 = upper_half(b);
  const double a2 = a - a1;
  const double b2 = b - b1;
  return {product, a2 * b2 - (((product - a1 * b1) - a2 * b1) - a1 * b2)};
}

inline DoubleDouble operator-(const DoubleDouble& a) { return {-a.high, -a.low}; }

inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble high = exact_sum(a.high, b.high);
  const DoubleDouble low = exact_sum(a.low, b.low);
  const DoubleDouble sum = exact_sum_of_ordered(high.high, high.low + low.high);
  return exact_sum_of_ordered(sum.high, sum.low + low.low);
}

inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }

inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble product = exact_product(a.high, b.high);
  return exact_sum_of_ordered(product.high,
                              product.low + (a.high * b.low + a.low * b.high + a.low * b.low));
}

inline DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
  const double first = a.high / b.high;
  const DoubleDouble rest = a - b * DoubleDouble{first, 0.0};
  const double second = rest.high / b.high;
  const DoubleDouble last = rest - b * DoubleDouble{second, 0.0};
  return exact_sum_of_ordered(first, second) + DoubleDouble{last.high / b.high, 0.0};
}

/// @param a at least 0
inline DoubleDouble sqrt(const DoubleDouble& a) {
  if (a.high == 0.0) return {};
  const double root = std::sqrt(a.high);
  const DoubleDouble rest = a - exact_product(root, root);
  return exact_sum_of_ordered(root, rest.high / (2.0 * root));
}

}  // namespace nextview
