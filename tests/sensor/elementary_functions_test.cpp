#include "sensor/elementary_functions.h"

#include <gtest/gtest.h>
#include <mpfr.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>

namespace nextview {
namespace {

// The obvious way: MPFR rounds correctly whatever the function.
template <class Function, class... Numbers>
double correctly_rounded(const Function& function, Numbers... arguments) {
  constexpr mpfr_prec_t kBits = std::numeric_limits<double>::digits;
  struct Number {
    explicit Number(double x) {
      mpfr_init2(bits, kBits);
      mpfr_set_d(bits, x, MPFR_RNDN);
    }
    ~Number() { mpfr_clear(bits); }
    mpfr_t bits;
  };
  Number result(0.0);
  function(result.bits, Number(arguments).bits..., MPFR_RNDN);
  return mpfr_get_d(result.bits, MPFR_RNDN);
}

// Numbers between two, and numbers of all sizes below the larger.
class Arguments {
 public:
  Arguments(double min, double max) : evenly_(min, max), size_(-30.0, 0.0), max_(max) {}

  double draw() {
    if (engine_() % 4 != 0) return evenly_(engine_);
    const double small = max_ * std::exp2(size_(engine_));
    return evenly_.min() < 0.0 && engine_() % 2 == 0 ? -small : small;
  }

 private:
  std::mt19937_64 engine_{7};
  std::uniform_real_distribution<double> evenly_;
  std::uniform_real_distribution<double> size_;
  double max_;
};

constexpr int kCases = 4000;

template <class Ours, class Theirs>
void expect_correctly_rounded(const char* name, double min, double max, const Ours& ours,
                              const Theirs& theirs) {
  Arguments arguments(min, max);
  for (int i = 0; i < kCases; ++i) {
    const double x = arguments.draw();
    ASSERT_EQ(ours(x), correctly_rounded(theirs, x)) << name << " " << std::hexfloat << x;
  }
}

// mpfr_sin and the like may be macros.
#define EXPECT_CORRECTLY_ROUNDED(name, min, max)                     \
  expect_correctly_rounded(                                          \
      #name, min, max, [](double x) { return elementary::name(x); }, \
      [](mpfr_t to, const mpfr_t x, mpfr_rnd_t how) { mpfr_##name(to, x, how); })

TEST(ElementaryFunctions, AreCorrectlyRounded) {
  EXPECT_CORRECTLY_ROUNDED(sin, -7.0, 7.0);
  EXPECT_CORRECTLY_ROUNDED(sin, -1e6, 1e6);
  EXPECT_CORRECTLY_ROUNDED(cos, -7.0, 7.0);
  EXPECT_CORRECTLY_ROUNDED(tan, -7.0, 7.0);
  EXPECT_CORRECTLY_ROUNDED(asin, -1.0, 1.0);
  EXPECT_CORRECTLY_ROUNDED(acos, -1.0, 1.0);
  EXPECT_CORRECTLY_ROUNDED(atan, -1e3, 1e3);
  EXPECT_CORRECTLY_ROUNDED(exp, -20.0, 1.0);
  EXPECT_CORRECTLY_ROUNDED(exp, -700.0, 700.0);
}

TEST(ElementaryFunctions, OfTwoArgumentsAreCorrectlyRounded) {
  Arguments arguments(-50.0, 50.0);
  for (int i = 0; i < kCases; ++i) {
    const double y = arguments.draw();
    const double x = arguments.draw();
    ASSERT_EQ(elementary::atan2(y, x), correctly_rounded(mpfr_atan2, y, x))
        << std::hexfloat << y << " " << x;
    ASSERT_EQ(elementary::hypot(x, y), correctly_rounded(mpfr_hypot, x, y))
        << std::hexfloat << x << " " << y;
  }
}

// Nearer to the middle between two doubles than the quick way can tell: 64 bits of the true values
// begin with the 53 of the result, a 1 and ten 0s or a 0 and ten 1s. One argument of a thousand is
// such a one.
TEST(ElementaryFunctions, AreCorrectlyRoundedWhereThatIsHardToTell) {
  Arguments arguments(-1.0, 1.0);
  int hard = 0;
  for (int i = 0; i < 100 * kCases && hard < 100; ++i) {
    const double x = arguments.draw();
    constexpr mpfr_prec_t kBits = 80;
    mpfr_t value;
    mpfr_init2(value, kBits);
    mpfr_set_d(value, x, MPFR_RNDN);
    mpfr_exp(value, value, MPFR_RNDN);
    const bool is_hard = mpfr_can_round(value, 64, MPFR_RNDN, MPFR_RNDN, 53) == 0;
    mpfr_clear(value);
    if (!is_hard) continue;
    ++hard;
    const auto exp_of = [](mpfr_t to, const mpfr_t of, mpfr_rnd_t how) { mpfr_exp(to, of, how); };
    ASSERT_EQ(elementary::exp(x), correctly_rounded(exp_of, x)) << std::hexfloat << x;
  }
  EXPECT_EQ(hard, 100);
}

TEST(ElementaryFunctions, OfTurnsKeepTheLastBits) {
  for (int quarters = -8; quarters <= 8; ++quarters) {
    const double x = quarters * (0.5 * std::numbers::pi);
    const auto sin_of = [](mpfr_t to, const mpfr_t of, mpfr_rnd_t how) { mpfr_sin(to, of, how); };
    const auto cos_of = [](mpfr_t to, const mpfr_t of, mpfr_rnd_t how) { mpfr_cos(to, of, how); };
    EXPECT_EQ(elementary::sin(x), correctly_rounded(sin_of, x)) << quarters;
    EXPECT_EQ(elementary::cos(x), correctly_rounded(cos_of, x)) << quarters;
  }
}

TEST(ElementaryFunctions, AtTheEndsOfTheirDomains) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto same = [](double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
  };
  EXPECT_EQ(elementary::asin(1.0), 0.5 * std::numbers::pi);
  EXPECT_EQ(elementary::asin(-1.0), -0.5 * std::numbers::pi);
  EXPECT_EQ(elementary::acos(-1.0), std::numbers::pi);
  EXPECT_EQ(elementary::acos(0.0), 0.5 * std::numbers::pi);
  EXPECT_TRUE(same(elementary::acos(1.0), 0.0));
  EXPECT_TRUE(same(elementary::sin(-0.0), -0.0));
  EXPECT_TRUE(same(elementary::tan(-0.0), -0.0));
  EXPECT_TRUE(same(elementary::atan2(-0.0, 1.0), -0.0));
  EXPECT_EQ(elementary::atan2(-0.0, -1.0), -std::numbers::pi);
  EXPECT_EQ(elementary::atan2(1.0, 0.0), 0.5 * std::numbers::pi);
  EXPECT_EQ(elementary::atan(kInfinity), 0.5 * std::numbers::pi);
  EXPECT_EQ(elementary::exp(0.0), 1.0);
  EXPECT_EQ(elementary::exp(-kInfinity), 0.0);
  EXPECT_EQ(elementary::exp(kInfinity), kInfinity);
  EXPECT_EQ(elementary::hypot(0.0, 0.0), 0.0);
  EXPECT_EQ(elementary::hypot(3.0, -4.0), 5.0);
  for (const double x : {nan, kInfinity, 1.0 + 1e-15}) {
    EXPECT_TRUE(std::isnan(elementary::asin(x)));
    EXPECT_TRUE(std::isnan(elementary::acos(x)));
  }
  for (const double x : {nan, kInfinity}) {
    EXPECT_TRUE(std::isnan(elementary::sin(x)));
    EXPECT_TRUE(std::isnan(elementary::cos(x)));
    EXPECT_TRUE(std::isnan(elementary::tan(x)));
  }
  EXPECT_TRUE(std::isnan(elementary::exp(nan)));
  EXPECT_TRUE(std::isnan(elementary::atan2(nan, 1.0)));
}

}  // namespace
}  // namespace nextview
