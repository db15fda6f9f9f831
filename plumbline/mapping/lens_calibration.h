// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/features/feature_correction.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/optimization/problem.h"

#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Applies a lens correction to all measurements of the left images of a problem, and scales their
// deviations alike.
void Correct(const LensCorrection& correction, BaProblem& problem);

// Returns the options of an adjustment of poses and points to a lens: no observation is taken out,
// so that the costs of several lenses count the same observations.
LocalBaOptions LensAdjustmentOptions(LocalBaOptions options);

// Result of CalibrateRadialDistortion.
struct RadialCalibration {
  LensCorrection correction;
  // Poses and points adjusted to that correction, by their index in the problem; empty without a
  // change.
  std::vector<Rigid3> poses;
  std::vector<Eigen::Vector3d> points;
  // True if no correction is applied, and the points exclude by four deviations that one matters:
  // the lens need not be estimated again.
  bool is_right = false;
};

// Estimates the lens correction from the points of a map of one camera. A little distortion changes
// the scale wherever the camera turns, because landmarks move from the side of the image to its
// centre.
//
// Method: Newton's method on the cost as a function of the correction, with all poses and points
// adjusted. At each correction they are adjusted (bundle adjustment of the points alone) from the
// solution for the nearest correction so far: from further away a few points converge to positions
// that fit no correction. Slope and curvature there follow from the normal equations, with the
// correction as one more unknown. The minimum is combined with a normal prior about zero, whose
// standard deviation is a hundredth of the image's width. A correction is accepted only if it
// lowers the cost by more than a deviation of six would (a likelihood ratio of 36); on straight
// motion the distortion is unobservable. If measurements are already corrected, the same test
// applies to the total correction: it is updated to the current estimate, or removed if the points
// are as clearly against it. There is no change if depth is measured (a pair), if it would be
// smaller than 2e-4 of the image's width, or when stopped.
//
//   problem   of a whole map: poses with a fixed gauge, points with all observations
//   known_px  border_px of the correction already applied to the measurements
//   returns   the correction to be applied in addition
//   cost      that of one adjustment of the points alone and one more iteration, of up to seven if
//             there may be a correction
RadialCalibration CalibrateRadialDistortion(const BaProblem& problem,
                                            double known_px = 0,
                                            const StopCheck& stop = {});

}  // namespace plumbline
