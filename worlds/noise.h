// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace plumbline {

// Random numbers as functions of position instead of steps of a stream: independent of the order
// and the number of threads.

// Mixes 64 bits thoroughly (the finalizer of SplitMix64).
inline std::uint64_t MixBits(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

// Hash of a grid cell under a seed.
inline std::uint64_t HashCell(std::int64_t x, std::int64_t y, std::uint64_t seed) {
  return MixBits(MixBits(static_cast<std::uint64_t>(x) ^ seed) + static_cast<std::uint64_t>(y));
}

// Uniform in [0, 1) from a hash.
inline double UnitFromHash(std::uint64_t hash) {
  return static_cast<double>(hash >> 11) * 0x1.0p-53;
}

// Close to a standard normal from one hash: the sum of its eight bytes, centred and scaled to unit
// variance. Bounded by +-4.88, ample for pixel noise.
inline float NormalFromHash(std::uint64_t hash) {
  const std::uint64_t pairs =
      (hash & 0x00FF00FF00FF00FFULL) + ((hash >> 8) & 0x00FF00FF00FF00FFULL);
  const std::uint64_t sum = (pairs * 0x0001000100010001ULL) >> 48;
  return (static_cast<float>(sum) - 1020.0F) * (1.0F / 209.0153F);
}

// Value noise in [-1, 1] with one feature per unit length: random values at the integer grid with
// smooth (cubic) blending between.
inline double ValueNoise(double x, double y, std::uint64_t seed) {
  const double fx = std::floor(x), fy = std::floor(y);
  const auto ix = static_cast<std::int64_t>(fx), iy = static_cast<std::int64_t>(fy);
  const double ax = x - fx, ay = y - fy;
  const double sx = ax * ax * (3 - 2 * ax), sy = ay * ay * (3 - 2 * ay);
  const double v00 = UnitFromHash(HashCell(ix, iy, seed));
  const double v10 = UnitFromHash(HashCell(ix + 1, iy, seed));
  const double v01 = UnitFromHash(HashCell(ix, iy + 1, seed));
  const double v11 = UnitFromHash(HashCell(ix + 1, iy + 1, seed));
  const double top = v00 + sx * (v10 - v00), bottom = v01 + sx * (v11 - v01);
  return 2 * (top + sy * (bottom - top)) - 1;
}

// Sum of `octaves` value noises, each at twice the frequency and `gain` times the strength of the
// previous one: gain 0.5 is smooth clouds, gain near 1 is grainy at all scales. Within +-1.
inline double FractalNoise(double x, double y, int octaves, double gain, std::uint64_t seed) {
  double sum = 0, weight = 1, total = 0;
  for (int i = 0; i < octaves; ++i) {
    sum += weight * ValueNoise(x, y, seed + static_cast<std::uint64_t>(i) * 7919U);
    total += weight;
    weight *= gain;
    x = 2.03 * x + 17.3;
    y = 2.03 * y - 9.1;
  }
  return sum / total;
}

}  // namespace plumbline
