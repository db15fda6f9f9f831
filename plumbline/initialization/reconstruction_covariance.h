// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/initialization/reconstruction.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// First-order covariance of motion and structure given the tracks.
struct ReconstructionCovariance {
  // Covariance of the left perturbations [rotation, translation] of all views, 6 by 6 for each. The
  // global scale is fixed.
  Eigen::MatrixXd poses;
  // For each point the standard deviation of its depth in the reference view, relative to that
  // depth, after scaling all points to the true scale. Negative if the point is unknown.
  std::vector<double> relative_depth_sigmas;
};

// Computes the covariance from the normal equations of the reprojection errors at a reconstruction,
// with the points eliminated. The reference and the scale are fixed, everything else is free.
//
//   noise       factor on the standard deviations of all measurements
//   max_chi2    measurements whose squared error exceeds it, in those deviations, do not count
//   line_noise  factor on the deviations of lines, if used; a line counts if it is an inlier in all
//               its views
//   returns     nullopt if the frames do not determine all poses
//   cost        O(points views^2)
std::optional<ReconstructionCovariance> ComputeCovariance(const FeatureTracks& tracks,
                                                          const Reconstruction& reconstruction,
                                                          double noise,
                                                          double max_chi2,
                                                          double line_noise = 1);

// Standard deviations of the pose of one view.
struct PoseAccuracy {
  double rotation = 0;  // in radians, about the worst axis
  // Deviation of the direction between the two camera centres, in radians, about the worst axis.
  double direction = 0;
};
PoseAccuracy AccuracyOf(const Reconstruction& reconstruction,
                        const ReconstructionCovariance& covariance,
                        int view);

}  // namespace plumbline
