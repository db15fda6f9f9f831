// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/types.h"

namespace plumbline {

// The nearest number with the 24 binary digits of single precision, for |value| < 1e290. Veltkamp's
// splitting (Dekker 1971) and no conversion to float and back: GCC 12 leaves such conversions out
// where it takes two of them together (its -ftree-slp-vectorize).
inline double InSinglePrecision(double value) {
  constexpr double kSplit = (1 << 29) + 1;
  const double high = kSplit * value;
  return high - (high - value);
}

// Rounds all that was measured in an image, but for the descriptors: positions, deviations, angles,
// responses, disparities, right lines. Their steps are below 1e-4 px then, far below what can be
// measured, and map files keep them exactly in four bytes.
void RoundToSinglePrecision(Features& features);

}  // namespace plumbline
