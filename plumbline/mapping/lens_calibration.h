// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/optimization/problem.h"

#include <Eigen/Core>

namespace plumbline {

// Radial distortion of the lens that the calibration has left. A place px of the image, at d from
// the principal point in halves of the image's width, belongs at px - border_px |d|^2 d. border_px
// is thus the correction at the side of the image, in pixels.
struct LensCorrection {
  double border_px = 0;

  Eigen::Vector2d At(const RectifiedCamera& camera, const Eigen::Vector2d& px) const;
  // Returns by how much the correction shrinks the surroundings of a place, in the mean over all
  // directions.
  double ScaleAt(const RectifiedCamera& camera, const Eigen::Vector2d& px) const;
};

// Moves all measurements of the left images of a problem to where they belong, and scales their
// deviations alike.
void Correct(const LensCorrection& correction, BaProblem& problem);

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
// nothing tells of the distortion. There is no correction where lengths are measured (a pair), or
// when `stop` says so.
//
//   problem  of a whole map: poses with their gauge held, points with all observations
//   cost     that of three adjustments of the points alone, of up to eight where there may be a
//            correction
struct LearnedLens {
  LensCorrection correction;
  // Poses and points adjusted to a correction near that one, by their index in the problem; empty
  // where there is no correction.
  std::vector<Rigid3> poses;
  std::vector<Eigen::Vector3d> points;
};
LearnedLens LearnLens(const BaProblem& problem, const StopCheck& stop = {});

}  // namespace plumbline
