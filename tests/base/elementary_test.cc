// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/elementary.h"

#include "plumbline/base/random.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Error in units of the last place of the true value.
double Ulps(double value, long double truth) {
  int exponent = 0;
  (void)std::frexp(static_cast<double>(truth), &exponent);
  return static_cast<double>(std::abs(value - truth) / std::ldexp(1.0L, exponent - 53));
}

constexpr int kDraws = 50000;

// The largest error against the long double function of the C library.
template <class Function, class Truth>
double WorstOf(Function function, Truth truth, double low, double high) {
  Rng rng(1, "elementary");
  double worst = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = rng.Uniform(low, high);
    worst = std::max(worst, Ulps(function(x), truth(static_cast<long double>(x))));
  }
  return worst;
}

using Long = long double;

TEST(Elementary, SineAndCosineAreWithinAnUlp) {
  for (const double range : {0.8, 7.0, 1e5}) {
    EXPECT_LT(WorstOf(
                  math::Sin, [](Long x) { return std::sin(x); }, -range, range),
              1)
        << range;
    EXPECT_LT(WorstOf(
                  math::Cos, [](Long x) { return std::cos(x); }, -range, range),
              1)
        << range;
  }
  EXPECT_LT(WorstOf(
                math::Tan, [](Long x) { return std::tan(x); }, -7, 7),
            2.5);
  // Nearest to multiples of pi/2 most digits cancel.
  for (int i = 1; i < 2000; ++i) {
    const double x = 0.5 * std::numbers::pi * i;
    EXPECT_LT(Ulps(math::Sin(x), std::sin(static_cast<Long>(x))), 1) << i;
    EXPECT_LT(Ulps(math::Cos(x), std::cos(static_cast<Long>(x))), 1) << i;
  }
}

TEST(Elementary, SineOfManyTurnsIsStillThatOfTheRest) {
  Rng rng(2, "elementary");
  for (const double range : {5e5, 1e7, 1e12, 1e15}) {
    for (int i = 0; i < 1000; ++i) {
      const double x = rng.Uniform(-range, range);
      EXPECT_NEAR(math::Sin(x), static_cast<double>(std::sin(static_cast<Long>(x))), 2e-16) << x;
      EXPECT_NEAR(math::Cos(x), static_cast<double>(std::cos(static_cast<Long>(x))), 2e-16) << x;
    }
  }
  for (const double x : {1e16, 1e100, std::numeric_limits<double>::max()}) {
    EXPECT_LE(std::abs(math::Sin(x)), 1);
    EXPECT_LE(std::abs(math::Cos(-x)), 1);
  }
}

TEST(Elementary, AnglesAreWithinTwoUlps) {
  for (const double range : {1e-5, 1.0, 20.0}) {
    EXPECT_LT(WorstOf(
                  math::Atan, [](Long x) { return std::atan(x); }, -range, range),
              2)
        << range;
  }
  EXPECT_LT(WorstOf(
                math::Asin, [](Long x) { return std::asin(x); }, -1, 1),
            3);
  EXPECT_LT(WorstOf(
                math::Acos, [](Long x) { return std::acos(x); }, -1, 1),
            3);
  Rng rng(3, "elementary");
  for (int i = 0; i < kDraws; ++i) {
    const double y = std::ldexp(rng.Uniform(-1, 1), static_cast<int>(rng.Index(30)));
    const double x = std::ldexp(rng.Uniform(-1, 1), static_cast<int>(rng.Index(30)));
    EXPECT_LT(Ulps(math::Atan2(y, x), std::atan2(static_cast<Long>(y), static_cast<Long>(x))), 2)
        << y << " " << x;
  }
}

TEST(Elementary, AnglesOfSpecialPlacesAreThoseOfTheCLibrary) {
  const double places[] = {0.0, -0.0, 1.0, -1.0, kInfinity, -kInfinity, 5e-324, 1e308, -1e308};
  for (const double y : places) {
    for (const double x : places) {
      const double expected = std::atan2(y, x);
      EXPECT_DOUBLE_EQ(math::Atan2(y, x), expected) << y << " " << x;
      EXPECT_EQ(std::signbit(math::Atan2(y, x)), std::signbit(expected)) << y << " " << x;
    }
    EXPECT_TRUE(std::isnan(math::Atan2(y, kNaN)));
    EXPECT_TRUE(std::isnan(math::Atan2(kNaN, y)));
  }
  EXPECT_EQ(math::Atan2(3, 3), std::numbers::pi / 4);
  EXPECT_EQ(math::Asin(1), std::numbers::pi / 2);
  EXPECT_EQ(math::Acos(-1), std::numbers::pi);
  EXPECT_TRUE(std::isnan(math::Acos(1.0000001)));
}

TEST(Elementary, ExponentialsAreWithinTheirUlps) {
  for (const double range : {1.0, 20.0, 700.0}) {
    EXPECT_LT(WorstOf(
                  math::Exp, [](Long x) { return std::exp(x); }, -range, range),
              1)
        << range;
  }
  for (const double range : {1e-12, 1e-3, 2.0}) {
    EXPECT_LT(WorstOf(
                  math::Expm1, [](Long x) { return std::expm1(x); }, -range, range),
              3);
    EXPECT_LT(WorstOf(
                  math::Tanh, [](Long x) { return std::tanh(x); }, -range, range),
              5);
  }
  EXPECT_EQ(math::Exp(0), 1);
  EXPECT_EQ(math::Exp(kInfinity), kInfinity);
  EXPECT_EQ(math::Exp(710), kInfinity);
  EXPECT_EQ(math::Exp(-kInfinity), 0);
  EXPECT_NEAR(math::Exp(-740) / std::exp(-740), 1, 0.1);  // few digits are left there
  EXPECT_EQ(math::Tanh(-kInfinity), -1);
  EXPECT_EQ(math::Expm1(-kInfinity), -1);
  EXPECT_TRUE(std::isnan(math::Exp(kNaN)));
}

TEST(Elementary, LogarithmsAreWithinTheirUlps) {
  EXPECT_LT(WorstOf(
                math::Log, [](Long x) { return std::log(x); }, 0, 10),
            1);
  EXPECT_LT(WorstOf(
                math::Log, [](Long x) { return std::log(x); }, 0.99, 1.01),
            1);
  EXPECT_LT(WorstOf(
                math::Log, [](Long x) { return std::log(x); }, 0, 1e300),
            1);
  EXPECT_LT(WorstOf(
                math::Log1p, [](Long x) { return std::log1p(x); }, -0.9, 2),
            3);
  EXPECT_LT(WorstOf(
                math::Log1p, [](Long x) { return std::log1p(x); }, -1e-9, 1e-9),
            3);
  EXPECT_LT(WorstOf(
                math::Log10, [](Long x) { return std::log10(x); }, 0, 100),
            3);
  for (int i = -22; i <= 22; ++i) {
    EXPECT_EQ(math::Log10(math::Pow(10.0, i)), i);
  }
  EXPECT_EQ(math::Log(1), 0);
  EXPECT_EQ(math::Log(0), -kInfinity);
  EXPECT_EQ(math::Log(kInfinity), kInfinity);
  EXPECT_EQ(math::Log1p(-1), -kInfinity);
  EXPECT_NEAR(math::Log(5e-324), std::log(5e-324), 1e-12);
  EXPECT_TRUE(std::isnan(math::Log(-1)));
}

TEST(Elementary, PowersAreWithinTheirUlps) {
  for (int i = 0; i <= 22; ++i) EXPECT_EQ(math::Pow(10.0, i), std::pow(10.0, i));
  EXPECT_EQ(math::Pow(2.0, -3), 0.125);
  EXPECT_EQ(math::Pow(0.0, 0), 1);
  Rng rng(4, "elementary");
  for (int i = 0; i < kDraws; ++i) {
    const double base = rng.Uniform(0.1, 4);
    const int whole = static_cast<int>(rng.Index(16)) - 4;
    const Long truth = std::pow(static_cast<Long>(base), whole);
    EXPECT_LE(Ulps(math::Pow(base, whole), truth), std::max(1, std::abs(whole))) << base;
    const double power = rng.Uniform(-4, 4);
    EXPECT_LT(Ulps(math::Pow(base, power), std::pow(static_cast<Long>(base), power)),
              2 + 2 * std::abs(power * std::log(base)))
        << base << " " << power;
  }
  EXPECT_EQ(math::Pow(0.0, 0.5), 0);
  EXPECT_EQ(math::Pow(7.0, 0.0), 1);
}

TEST(Elementary, RootsAndLengthsAreWithinTwoUlps) {
  for (const double range : {1e-300, 1.0, 1e5, 1e300}) {
    EXPECT_LT(WorstOf(
                  math::Cbrt, [](Long x) { return std::cbrt(x); }, -range, range),
              2)
        << range;
    Rng rng(5, "elementary");
    for (int i = 0; i < 1000; ++i) {
      const double x = rng.Uniform(-range, range);
      const double y = rng.Uniform(-range, range);
      EXPECT_LT(Ulps(math::Hypot(x, y), std::hypot(static_cast<Long>(x), static_cast<Long>(y))), 2);
    }
  }
  EXPECT_EQ(math::Hypot(3, -4), 5);
  EXPECT_EQ(math::Hypot(0, 0), 0);
  EXPECT_EQ(math::Hypot(kNaN, -kInfinity), kInfinity);
  EXPECT_TRUE(std::isnan(math::Hypot(kNaN, 1)));
  EXPECT_EQ(math::Cbrt(-0.0), 0);
  EXPECT_EQ(math::Cbrt(-27), -3);
}

// A change of one bit anywhere shows here, on whatever machine this runs.
TEST(Elementary, GivesTheSameBitsOnEveryMachine) {
  Rng rng(6, "elementary");
  std::uint64_t hash = 0;
  const auto add = [&](double value) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001b3U;
  };
  for (int i = 0; i < kDraws; ++i) {
    const double x = rng.Uniform(-9, 9);
    const double y = rng.Uniform(0, 9);
    for (const double value : {math::Sin(x), math::Cos(x), math::Tan(x), math::Atan(x)}) add(value);
    for (const double value : {math::Exp(x), math::Expm1(x), math::Tanh(x), math::Cbrt(x)}) {
      add(value);
    }
    for (const double value : {math::Log(y), math::Log1p(y), math::Log10(y)}) add(value);
    for (const double value : {math::Atan2(y, x), math::Hypot(x, y), math::Pow(y, x)}) add(value);
    add(math::Asin(x / 9));
    add(math::Acos(x / 9));
    add(math::Pow(x, 7));
  }
  EXPECT_EQ(hash, 0x29c9591320d52bbfU) << std::hex << hash;
}

}  // namespace
}  // namespace plumbline
