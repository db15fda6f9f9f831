// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/consistency/consistency_sample.h"
#include "plumbline/geometry/rectified_camera.h"
#include "worlds/parallelogram.h"
#include "worlds/true_line.h"

#include <span>
#include <vector>

namespace plumbline {

// The known world in front of the true cameras.
struct TrueSurroundings {
  std::span<const TrueLine> lines;
  std::span<const Parallelogram> surfaces;
};

// Returns the errors of a map's landmarks, triangulated at the true poses from all that keyframes
// measured of them, against a known world.
//
//   points    distance from the nearest surface across it, against the point's covariance; infinite
//             where there is none within 5 cm and 5 deviations
//   lines     distances across at both ends from the nearest true line that differs by at most 2
//             degrees, and by 2 px and three deviations, against the line's covariance. Lines
//             without one are left out, since not all that is seen is listed, and those known to
//             less than 2 px.
//   segments  of these lines, against the projected true line and by the covariance of the
//             measurement alone
//   poses     true poses, in the world of the truth, metres
std::vector<ConsistencySample> LandmarkSamples(const Map& map,
                                               const RectifiedCamera& camera,
                                               const KeyFramePoses& poses,
                                               const TrueSurroundings& truth);

}  // namespace plumbline
