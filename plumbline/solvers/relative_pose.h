// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/random.h"
#include "plumbline/geometry/se3.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// One point seen by two cameras: ideal image coordinates (x/z, y/z) and the standard deviation of
// each of them (pixels over the focal length).
struct RayMatch {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  double sigma_a = 1e-3;
  double sigma_b = 1e-3;
};

enum class RelativePoseModel { kEssential, kHomography };

// A pose that explains the matches, with all that was decided on the way.
struct RelativePoseHypothesis {
  RelativePoseModel model = RelativePoseModel::kEssential;
  Rigid3 b_from_a;              // |translation| = 1
  std::vector<bool> is_inlier;  // by match: Sampson distance within chi2 95 % (1 degree of freedom)
  int inliers = 0;
  int in_front = 0;  // inliers that triangulate in front of both cameras
  double cost = 0;   // sum over matches of min(chi2, gate)
  // Of (left rotation tangent, two directions across the translation); see the .cc for the basis.
  Eigen::Matrix<double, 5, 5> covariance = Eigen::Matrix<double, 5, 5>::Zero();
};

}  // namespace plumbline
