// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/types.h"

#include <Eigen/Core>

namespace plumbline {

// Returns the nearest number with the 24 binary digits of single precision, for |value| < 1e290, by
// Veltkamp's splitting (Dekker 1971). GCC 12 drops a conversion to float and back if it needs two
// of them together (its -ftree-slp-vectorize).
inline double InSinglePrecision(double value) {
  constexpr double kSplit = (1 << 29) + 1;
  const double high = kSplit * value;
  return high - (high - value);
}

inline Eigen::Vector2d InSinglePrecision(const Eigen::Vector2d& value) {
  return {InSinglePrecision(value.x()), InSinglePrecision(value.y())};
}

inline Eigen::Vector4d InSinglePrecision(const Eigen::Vector4d& value) {
  return {InSinglePrecision(value(0)),
          InSinglePrecision(value(1)),
          InSinglePrecision(value(2)),
          InSinglePrecision(value(3))};
}

// Rounds all measurements of an image except the descriptors: positions, deviations, angles,
// responses, disparities, right lines. The rounding steps are below 1e-4 px, far below the accuracy
// of measurements, and map files store the numbers exactly in four bytes.
void RoundToSinglePrecision(Features& features);

}  // namespace plumbline
