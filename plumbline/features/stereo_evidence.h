// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

namespace plumbline {

// Evidence of all keyframes so far about the errors of a stereo pair: normal equations of the
// coefficients of a StereoCorrection. It depends on the rig, not on a map, and evidence of
// different keyframes can be summed.
struct StereoEvidence {
  Matrix6d information = Matrix6d::Zero();
  Vector6d weighted = Vector6d::Zero();
  // Second moments of the terms over all evidence, unscaled.
  Matrix6d moments = Matrix6d::Zero();
};

}  // namespace plumbline
