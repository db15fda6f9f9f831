// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/lens_correction.h"
#include "plumbline/features/stereo_correction.h"
#include "plumbline/features/types.h"

namespace plumbline {

// What a run has learned about the cameras beyond their calibration, and by which features are
// corrected: the displacement of a pair's images, and the distortion of a single camera's lens.
struct FeatureCorrection {
  StereoCorrection stereo = {};
  LensCorrection lens = {};

  bool operator==(const FeatureCorrection&) const = default;
  bool IsPlausible() const;
};

// Gives features another correction than `before`, which they have. The measured numbers, which
// have single precision, are recovered exactly (where the correction changes by less than half a
// pixel from pixel to pixel) and corrected anew. The result does not depend on the corrections in
// between, to the last bit.
void Correct(const FeatureCorrection& before,
             const FeatureCorrection& correction,
             Features& features);

}  // namespace plumbline
