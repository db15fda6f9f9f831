// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/features/lens_correction.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/optimization/problem.h"

#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Moves all measurements of the left images of a problem to where they belong, and scales their
// deviations alike.
void Correct(const LensCorrection& correction, BaProblem& problem);

// What CalibrateRadialDistortion found.
struct RadialCalibration {
  LensCorrection correction;
  // Poses and points adjusted to that correction, by their index in the problem; empty where there
  // is no change.
  std::vector<Rigid3> poses;
  std::vector<Eigen::Vector3d> points;
};

// Learns the lens correction from the points of a map of one camera. A little distortion changes
// the scale wherever the camera turns, because what passes through the middle of the image was at
// its side before.
//
// How: the profile of the cost over the correction is sampled. For each correction all poses and
// points are adjusted (bundle adjustment of the points alone), starting from the solution for the
// nearest correction so far: from further away a few points stick where they fit no correction. The
// minimum is found by successive parabolas and joined with a normal prior about zero, whose
// deviation is a hundredth of the image's width. A correction counts only if it lowers the cost by
// more than a deviation of six would (a likelihood ratio of 36); where the camera goes straight on,
// nothing tells of the distortion. Where measurements have had a correction already, the same is
// asked of the whole correction: it is changed to what the points say now, and taken back where
// they speak as clearly against it. There is no change where lengths are measured (a pair), where
// it would be smaller than 2e-4 of the image's width, or when `stop` says so.
//
//   problem   of a whole map: poses with their gauge held, points with all observations
//   known_px  border_px of the correction that the measurements have had
//   returns   the correction that is to be made in addition
//   cost      that of three adjustments of the points alone, of up to ten where there may be a
//             correction
RadialCalibration CalibrateRadialDistortion(const BaProblem& problem,
                                            double known_px = 0,
                                            const StopCheck& stop = {});

}  // namespace plumbline
