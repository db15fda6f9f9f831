// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/lens_correction.h"
#include "plumbline/features/stereo_correction.h"
#include "plumbline/features/types.h"

namespace plumbline {

// Correction of features learned during a run, beyond the calibration: the displacement between the
// images of a pair, and the lens distortion of a single camera.
struct FeatureCorrection {
  StereoCorrection stereo = {};
  LensCorrection lens = {};

  bool operator==(const FeatureCorrection&) const = default;
  bool IsPlausible() const;
};

// Replaces the correction `before` of features by another one. The measured numbers, which have
// single precision, are recovered exactly (if the correction changes by less than half a pixel from
// pixel to pixel) and corrected anew. The result does not depend on earlier corrections, to the
// last bit.
void Correct(const FeatureCorrection& before,
             const FeatureCorrection& correction,
             Features& features);

}  // namespace plumbline
