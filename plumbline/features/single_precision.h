// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/types.h"

namespace plumbline {

// The nearest number of single precision.
inline double InSinglePrecision(double value) {
  return static_cast<double>(static_cast<float>(value));
}

// Rounds all that was measured in an image, but for the descriptors: positions, deviations, angles,
// responses, disparities, right lines. Their steps are below 1e-4 px then, far below what can be
// measured, and map files keep them exactly in four bytes.
void RoundToSinglePrecision(Features& features);

}  // namespace plumbline
