// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/optimization/problem.h"

#include <Eigen/Core>

namespace plumbline {

// What the calibration has left of the lens's radial distortion: a place px of the image, d from
// the principal point in halves of the image's width, belongs at px - border_px |d|^2 d. In pixels
// at the side of the image.
struct LensCorrection {
  double border_px = 0;

  Eigen::Vector2d At(const RectifiedCamera& camera, const Eigen::Vector2d& px) const;
  // By how much the correction shrinks what is around a place, in the mean over all directions.
  double ScaleAt(const RectifiedCamera& camera, const Eigen::Vector2d& px) const;
};

// Takes all measurements of the left images of a problem, and their deviations, to where they
// belong.
void Correct(const LensCorrection& correction, BaProblem& problem);

// The correction that the points of a map speak for: with one camera alone, a little distortion
// changes the scale wherever the camera turns, for what passes through the middle of the image
// there was at its side before.
//
// How: the profile of the cost over the correction, all poses and points adjusted for each (bundle
// adjustment of the points alone) from where they are for the nearest correction so far: from far
// away a few points stick where they fit no correction. Its minimum by successive parabolas, joined
// with a normal distribution about none, its deviation a hundredth of the image's width. A
// correction that lowers the cost by less than six deviations would (a likelihood ratio of 36) is
// none: where the camera goes straight on, nothing tells of it. None either where lengths are
// measured (a pair), or when `stop` says so.
//
//   problem  of a whole map: poses with their gauge held, points with all observations
//   cost     that of three adjustments of the points alone, of up to eight where there may be a
//            correction
struct LearnedLens {
  LensCorrection correction;
  // Adjusted to a correction near that, by their place in the problem; empty where there is none.
  std::vector<Rigid3> poses;
  std::vector<Eigen::Vector3d> points;
};
LearnedLens LearnLens(const BaProblem& problem, const StopCheck& stop = {});

}  // namespace plumbline
