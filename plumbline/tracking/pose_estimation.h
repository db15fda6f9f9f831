// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/line_cutting/cut_lines.h"
#include "plumbline/map/frame.h"
#include "plumbline/matching/line_method.h"
#include "plumbline/optimization/pose_optimization.h"
#include "plumbline/optimization/pose_uncertainty.h"
#include "plumbline/tracking/landmark_matches.h"

namespace plumbline {

// Pose of a frame, its uncertainty, and its numbers of inliers.
struct PoseEstimate {
  Rigid3 cam_from_world;
  // Information of the inliers and the prior about the left perturbation [rotation, translation].
  Matrix6d information = Matrix6d::Zero();
  double scene_depth = 0;  // median depth of the inliers
  // Deviation of the pose by inliers and prior together; infinite if these do not determine the
  // pose.
  PoseUncertainty sigma;
  int inlier_points = 0;
  int inlier_lines = 0;
  bool converged = false;
  int cut_lines = 0;  // lines of which only a piece was used, in any image

  int Inliers() const { return inlier_points + inlier_lines; }
  // Returns true with enough inliers, if these and the prior determine all six degrees of freedom.
  bool Accepted(int min_inliers, double max_sigma) const {
    return Inliers() >= min_inliers && converged && sigma.AtMost(max_sigma);
  }
};

// Estimates poses of the frames of one camera (or rig) from matches with landmarks.
//
// Thread-safe, since it stores only the camera and its options.
class PoseEstimator {
 public:
  PoseEstimator(const RectifiedCamera& camera,
                const LineSettings& lines,
                const CuttingSettings& cutting)
      : camera_(camera), lines_(lines), cutting_(cutting) {}

  // Returns the pose that best fits the matches and the prior, starting from `initial`. Outliers
  // are removed from the association. Each line counts once, in however many images of the rig it
  // is visible. With a method in `cutting` the pose is estimated from pieces of the lines
  // (line_cutting.h), but outliers are determined by whole lines.
  PoseEstimate Estimate(const Features& features,
                        const Rigid3& initial,
                        const PosePrior& prior,
                        LandmarkMatches& association) const;

  // Removes the outliers of a pose: matches with a chi2 above gate_scale times its limit of 95 %.
  void DropDisagreeing(const Features& features,
                       const Rigid3& cam_from_world,
                       double gate_scale,
                       LandmarkMatches& association) const;

  const LineSettings& lines() const { return lines_; }

 private:
  RectifiedCamera camera_;
  LineSettings lines_;
  CuttingSettings cutting_;
};

}  // namespace plumbline
