// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

namespace plumbline {

// What the disparities of all keyframes so far say about the errors of a stereo pair: normal
// equations of the coefficients of a StereoCorrection. The evidence is about the rig, not about a
// map, and evidence of different keyframes can be added.
struct StereoEvidence {
  Matrix6d information = Matrix6d::Zero();
  Vector6d weighted = Vector6d::Zero();
  // Second moments of the terms over all evidence, with scales as they are.
  Matrix6d moments = Matrix6d::Zero();
};

}  // namespace plumbline
