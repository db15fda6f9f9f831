// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

namespace plumbline {

// What the disparities of all keyframes so far say about the errors of a stereo pair: normal
// equations of the coefficients of a StereoCorrection. It speaks of the rig, not of a map, and sums
// of evidence of different keyframes are evidence.
struct StereoEvidence {
  Matrix6d information = Matrix6d::Zero();
  Vector6d weighted = Vector6d::Zero();
  Matrix6d moments = Matrix6d::Zero();  // of the terms over all evidence, scales as they are
};

}  // namespace plumbline
