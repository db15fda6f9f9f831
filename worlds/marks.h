// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worlds/noise.h"

#include <cmath>
#include <cstdint>

namespace plumbline {

// Small marks common to several materials.

inline double CellIndex(double x, double size) { return std::floor(x / size); }

inline double CellValue(double i, double j, std::uint64_t seed) {
  return UnitFromHash(HashCell(static_cast<std::int64_t>(i), static_cast<std::int64_t>(j), seed));
}

// Dark or bright dots of all strengths with one candidate per square of the given size; -1 to 1,
// falling off over the outer fifth of a dot.
double Specks(double u, double v, double size, double share, std::uint64_t seed);

// Rows of "words" in a column of the given width: marks of random width; some rows end early, some
// are empty. 0 to 1; the ink is not equally black everywhere.
double TextInk(double u, double v, double line, double width, std::uint64_t seed);

// Stripes along the first coordinate with fibres and knots, as in sawn wood; mean about 0.
double WoodGrain(double along, double across, std::uint64_t seed);

// Ageing of any surface: broad shades and dirt at all scales down to millimetres; mean about 0,
// within about +-0.5 times `strength`.
double Weathering(double u, double v, double strength, std::uint64_t seed);

}  // namespace plumbline
