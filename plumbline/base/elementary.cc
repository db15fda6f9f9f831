// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/elementary.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>

namespace plumbline::math {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// An unrounded value high + low, with low below an ulp of high.
struct Pair {
  double high;
  double low;
};

constexpr Pair kHalfPi = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
constexpr Pair kPi = {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
constexpr Pair kTwoPi = {0x1.921fb54442d18p+2, 0x1.1a62633145c07p-52};

// Returns the sum of two numbers without rounding (Knuth 1969).
Pair Sum(double a, double b) {
  const double sum = a + b;
  const double part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

// Returns coefficients[0] + x (coefficients[1] + x (...)).
template <std::size_t N>
double Polynomial(const std::array<double, N>& coefficients, double x) {
  double sum = coefficients[N - 1];
  for (std::size_t i = N - 1; i-- > 0;) sum = coefficients[i] + x * sum;
  return sum;
}

// x minus the nearest multiple of pi/2, which is the quadrant-th (modulo 4).
struct Reduced {
  int quadrant;
  Pair angle;  // between -pi/4 and pi/4
};

// Reduces as Cody and Waite (1980) do: pi/2 is split into three parts, whose products with `turns`
// are exact.
Reduced ReduceSmall(double x) {
  constexpr double kFirst = 0x1.921fb544p+0;  // 33 bits
  constexpr double kSecond = 0x1.0b4611a6p-34;
  constexpr double kThird = 0x1.3198a2e037073p-69;
  const int quadrant = static_cast<int>(x * (2 / std::numbers::pi) + (x < 0 ? -0.5 : 0.5));
  const double turns = quadrant;
  const Pair rest = Sum(x - turns * kFirst, -turns * kSecond);
  return {quadrant, Sum(rest.high, rest.low - turns * kThird)};
}

Reduced Reduce(double x) {
  constexpr double kMaxSmall = 0x1p19;  // its quadrant has 19 bits
  if (std::abs(x) < kMaxSmall) return ReduceSmall(x);
  // Subtracting whole turns of 2 pi as a double leaves an exact remainder; the error of that 2 pi
  // is corrected afterwards.
  const double remainder = std::remainder(x, kTwoPi.high);
  const double turns = std::round((x - remainder) / kTwoPi.high);
  const Pair rest = Sum(remainder, -turns * kTwoPi.low);
  if (!(std::abs(rest.high) < 4)) return {0, {std::remainder(rest.high, kTwoPi.high) / 8, 0}};
  const Reduced part = ReduceSmall(rest.high);
  return {part.quadrant, Sum(part.angle.high, part.angle.low + rest.low)};
}

// Taylor series for angles within pi/4.
double SinOf(const Pair& angle) {
  constexpr std::array<double, 8> kSeries = {-1.0 / 6,
                                             1.0 / 120,
                                             -1.0 / 5040,
                                             1.0 / 362880,
                                             -1.0 / 39916800,
                                             1.0 / 6227020800,
                                             -1.0 / 1307674368000,
                                             1.0 / 355687428096000};
  const double z = angle.high * angle.high;
  return angle.high + (angle.low * (1 - 0.5 * z) + angle.high * z * Polynomial(kSeries, z));
}

double CosOf(const Pair& angle) {
  constexpr std::array<double, 8> kSeries = {1.0 / 24,
                                             -1.0 / 720,
                                             1.0 / 40320,
                                             -1.0 / 3628800,
                                             1.0 / 479001600,
                                             -1.0 / 87178291200,
                                             1.0 / 20922789888000,
                                             -1.0 / 6402373705728000};
  const double z = angle.high * angle.high;
  const double sum = 1 - 0.5 * z;
  // 1 - sum is exact, so that the part lost by 1 - z/2 can be added to the small terms.
  return sum + (((1 - sum) - 0.5 * z) + (z * z * Polynomial(kSeries, z) - angle.high * angle.low));
}

// Returns the sine of the angle plus `quarters` right angles.
double SinAfter(const Pair& angle, int quarters) {
  const auto turn = static_cast<unsigned>(quarters) % 4;
  const double value = turn % 2 == 0 ? SinOf(angle) : CosOf(angle);
  return turn < 2 ? value : -value;
}

// The values of atan(k/8).
constexpr std::array<Pair, 9> kAtanOfEighths = {{{0, 0},
                                                 {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                                                 {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                                 {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                                                 {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                                 {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                                                 {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                                 {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                                                 {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}}};

// Returns start + sign * atan(small / large) for 0 <= small <= large. With c = k/8 nearest to the
// ratio, atan(ratio) = atan(c) + atan((small - c large) / (large + c small)).
double AnglePast(const Pair& start, double sign, double small, double large) {
  constexpr std::array<double, 7> kSeries = {
      -1.0 / 3, 1.0 / 5, -1.0 / 7, 1.0 / 9, -1.0 / 11, 1.0 / 13, -1.0 / 15};
  const auto k = static_cast<std::size_t>(8 * (small / large) + 0.5);
  const double c = 0.125 * static_cast<double>(k);
  const double ratio = (small - c * large) / (large + c * small);
  const double square = ratio * ratio;
  const double cubic = ratio * square * Polynomial(kSeries, square);
  const Pair base = Sum(start.high, sign * kAtanOfEighths[k].high);
  const double low = base.low + (start.low + sign * kAtanOfEighths[k].low);
  if (base.high == 0) return sign * (ratio + cubic);
  return base.high + (sign * ratio + (sign * cubic + low));
}

// The number mantissa 2^exponent, with the mantissa within [sqrt(1/2), sqrt(2)].
struct Scaled {
  double mantissa;
  int exponent;
};

// Returns x > 0, which must be finite, in scaled form.
Scaled Normalized(double x) {
  Scaled result{};
  result.mantissa = std::frexp(x, &result.exponent);  // within [1/2, 1)
  if (result.mantissa < std::numbers::sqrt2 / 2) {
    result.mantissa *= 2;
    --result.exponent;
  }
  return result;
}

constexpr Pair kLog2 = {0x1.62e42feep-1, 0x1.a39ef35793c76p-33};  // 32 bits, and the rest

// Returns x 2^exponent. The power is a product of two if no double represents it.
double ScaledBy(double x, int exponent) {
  const auto power = [](int n) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + n) << 52U);
  };
  if (exponent >= -1022 && exponent <= 1023) return x * power(exponent);
  const int half = exponent / 2;
  return x * power(half) * power(exponent - half);
}

}  // namespace

double Sin(double x) {
  if (!std::isfinite(x)) return kNaN;
  if (x == 0) return x;
  const Reduced reduced = Reduce(x);
  return SinAfter(reduced.angle, reduced.quadrant);
}

double Cos(double x) {
  if (!std::isfinite(x)) return kNaN;
  const Reduced reduced = Reduce(x);
  return SinAfter(reduced.angle, reduced.quadrant + 1);
}

double Tan(double x) {
  if (!std::isfinite(x)) return kNaN;
  if (x == 0) return x;
  const Reduced reduced = Reduce(x);
  return SinAfter(reduced.angle, reduced.quadrant) / SinAfter(reduced.angle, reduced.quadrant + 1);
}

double Atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) return kNaN;
  double across = std::abs(y);
  double along = std::abs(x);
  if (std::isinf(across) && std::isinf(along)) across = along = 1;
  const bool backwards = std::signbit(x);
  const double large = std::max(across, along);
  if (large == 0 || along == kInfinity) return std::copysign(backwards ? kPi.high : 0, y);
  if (across == kInfinity) return std::copysign(kHalfPi.high, y);
  // The scale avoids the overflow of sums and the loss of digits in products.
  const double scale = large > 0x1p1000 ? 0x1p-4 : large < 0x1p-900 ? 0x1p100 : 1;
  across *= scale;
  along *= scale;
  double angle = 0;
  if (across > along) {
    angle = AnglePast(kHalfPi, backwards ? 1 : -1, along, across);
  } else {
    angle = backwards ? AnglePast(kPi, -1, across, along) : AnglePast({0, 0}, 1, across, along);
  }
  return std::copysign(angle, y);
}

double Atan(double x) { return Atan2(x, 1); }

double Asin(double x) { return Atan2(x, std::sqrt((1 - x) * (1 + x))); }

double Acos(double x) { return Atan2(std::sqrt((1 - x) * (1 + x)), x); }

double Exp(double x) {
  if (std::isnan(x)) return kNaN;
  if (x > 709.8) return kInfinity;
  if (x < -745.2) return 0;
  constexpr std::array<double, 13> kSeries = {1.0 / 2,
                                              1.0 / 6,
                                              1.0 / 24,
                                              1.0 / 120,
                                              1.0 / 720,
                                              1.0 / 5040,
                                              1.0 / 40320,
                                              1.0 / 362880,
                                              1.0 / 3628800,
                                              1.0 / 39916800,
                                              1.0 / 479001600,
                                              1.0 / 6227020800,
                                              1.0 / 87178291200};
  const int exponent = static_cast<int>(x * std::numbers::log2e + (x < 0 ? -0.5 : 0.5));
  const Pair rest = Sum(x - exponent * kLog2.high, -exponent * kLog2.low);
  const double r = rest.high;
  return ScaledBy(1 + (r + (rest.low + r * r * Polynomial(kSeries, r))), exponent);
}

// After Kahan: rounding exp(x) does the same to the difference and to the logarithm.
double Expm1(double x) {
  const double power = Exp(x);
  if (power == 1 || std::isinf(power) || std::isnan(power)) return power == 1 ? x : power;
  const double difference = power - 1;
  return std::abs(x) > 1 ? difference : difference * x / Log(power);
}

double Tanh(double x) {
  if (std::abs(x) > 20) return std::copysign(1, x);
  const double difference = Expm1(2 * x);
  return difference / (difference + 2);
}

double Log(double x) {
  if (std::isnan(x) || x < 0) return kNaN;
  if (x == 0) return -kInfinity;
  if (x == kInfinity) return x;
  // The series is log((1 + s) / (1 - s)) = 2 s + 2/3 s^3 + ..., |s| < 0.172.
  constexpr std::array<double, 10> kSeries = {2.0 / 3,
                                              2.0 / 5,
                                              2.0 / 7,
                                              2.0 / 9,
                                              2.0 / 11,
                                              2.0 / 13,
                                              2.0 / 15,
                                              2.0 / 17,
                                              2.0 / 19,
                                              2.0 / 21};
  const Scaled scaled = Normalized(x);
  const double f = scaled.mantissa - 1;
  const double s = f / (2 + f);
  const double z = s * s;
  // 2 s = f - s f = f - f^2/2 + s f^2/2, where f is exact and the other terms are small.
  const double half_square = 0.5 * f * f;
  const double small =
      half_square - (s * (half_square + z * Polynomial(kSeries, z)) + scaled.exponent * kLog2.low);
  return scaled.exponent * kLog2.high - (small - f);
}

// After Kahan, with the same idea as in Expm1.
double Log1p(double x) {
  const double sum = 1 + x;
  if (sum == 1 || sum == kInfinity) return x;
  return std::abs(x) > 1 ? Log(sum) : Log(sum) * (x / (sum - 1));
}

double Log10(double x) {
  const double value = Log(x) / std::numbers::ln10;
  if (!(std::abs(value) < 22.5)) return value;
  const double whole = std::round(value);
  return Pow(10, static_cast<int>(whole)) == x ? whole : value;
}

double Pow(double base, int exponent) {
  if (exponent < 0) return 1 / Pow(base, -exponent);
  double power = 1;
  for (double square = base; exponent > 0; exponent /= 2, square *= square) {
    if (exponent % 2 == 1) power *= square;
  }
  return power;
}

double Pow(double base, double exponent) {
  if (exponent == 0 || base == 1) return 1;
  return Exp(exponent * Log(base));
}

double Cbrt(double x) {
  if (x == 0 || !std::isfinite(x)) return x;
  const Scaled scaled = Normalized(std::abs(x));
  const int third = (scaled.exponent + 3 * 400) / 3 - 400;  // rounded down
  const double rest = std::ldexp(scaled.mantissa, scaled.exponent - 3 * third);
  double root = Exp(Log(rest) / 3);
  root -= (root * root * root - rest) / (3 * root * root);
  return std::copysign(std::ldexp(root, third), x);
}

double Hypot(double x, double y) {
  if (std::isinf(x) || std::isinf(y)) return kInfinity;
  const double large = std::max(std::abs(x), std::abs(y));
  if (large > 0x1p500 || large < 0x1p-450) {
    if (!(large > 0) || std::isnan(x) || std::isnan(y)) return x + y;
    const double scale = large > 1 ? 0x1p-600 : 0x1p600;
    return std::sqrt(x * scale * (x * scale) + y * scale * (y * scale)) / scale;
  }
  return std::sqrt(x * x + y * y);
}

}  // namespace plumbline::math
