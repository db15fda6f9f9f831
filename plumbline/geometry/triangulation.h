// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"

#include <optional>
#include <span>

#include <Eigen/Core>

namespace plumbline {

struct PointEstimate {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // m^2
};

// Returns the point in another frame.
PointEstimate Transform(const Rigid3& b_from_a, const PointEstimate& point_in_a);

// A point seen by one camera (or, with a disparity, by a pair).
struct PointView {
  Rigid3 cam_from_world;
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
  double sigma_px = 1;
  std::optional<Disparity> disparity;
};

struct PointTriangulationOptions {
  // Least angle [rad] that the widest pair of viewing rays must have.
  double min_parallax = 0.02;
  int max_iterations = 6;  // Gauss-Newton steps
};

enum class PointTriangulationFailure {
  kTooFewViews,    // fewer than two rays; a view with a disparity has two
  kSmallParallax,  // all rays within min_parallax
  kBehindCamera,   // depth <= 0 in a view
  kSingular,       // the measurements do not fix the point
};

struct TriangulatedPoint {
  PointEstimate point;  // in the world
  double parallax = 0;  // largest angle between two rays from the point, radians
  double chi2 = 0;      // sum of squared residuals over their variances
  int residuals = 0;    // number of them; chi2 has residuals - 3 degrees of freedom
};

// Triangulates a point from two or more views. The linear solution (DLT in the first camera's
// frame) is refined by Gauss-Newton on the reprojection and disparity errors; the normal matrix
// gives the covariance.
//
// The caller must check chi2. O(n), parallax O(n^2).
Expected<TriangulatedPoint, PointTriangulationFailure> TriangulatePoint(
    const RectifiedCamera& camera,
    std::span<const PointView> views,
    const PointTriangulationOptions& options = {});

}  // namespace plumbline
