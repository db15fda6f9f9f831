// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"
#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/geometry/segment.h"

#include <optional>
#include <span>

#include <Eigen/Core>

namespace plumbline {

// A point seen by one camera (or, with a disparity, by a pair).
struct PointView {
  Rigid3 cam_from_world;
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
  double sigma_px = 1;
  std::optional<Disparity> disparity;
};

// Conditions of TriangulatePoint and TriangulateLine on the views.
struct TriangulationOptions {
  // Least angle [rad] that the widest pair of viewing rays, or of interpretation planes, must have.
  double min_angle = 0.02;
  // Lines: largest distance of an end point from the reprojected line, in its sigmas, in every
  // view. Points: not used, the caller checks chi2.
  double max_residual_sigma = 3;
  // Gauss-Newton steps after the linear solution; with 0 the linear solution is the result.
  int max_iterations = 6;
};

// Reasons why TriangulatePoint fails.
enum class PointTriangulationFailure {
  kTooFewViews,    // fewer than two rays; a view with a disparity has two
  kSmallParallax,  // all rays within min_angle
  kBehindCamera,   // depth <= 0 in a view
  kSingular,       // the measurements do not fix the point
};

// A triangulated point and its residuals.
struct TriangulatedPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();    // in the world
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // m^2
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
    const TriangulationOptions& options = {});

// A segment seen by one camera.
struct LineView {
  Rigid3 cam_from_world;
  Segment2 segment;
  double sigma_px = 1;  // standard deviation of each end point across the line
};

// Returns the pose of the right camera of a rectified pair, displaced by the baseline along +x.
inline Rigid3 RightCamera(const RectifiedCamera& camera, const Rigid3& left_from_world) {
  return {left_from_world.rotation,
          left_from_world.translation - Eigen::Vector3d(camera.baseline, 0, 0)};
}

// Returns the plane (n, d), n.X + d = 0, |n| = 1, in the world, through the camera centre and a
// segment. Returns nullopt for a segment of zero length.
std::optional<Eigen::Vector4d> InterpretationPlane(const RectifiedCamera& camera,
                                                   const LineView& view);

// Reasons why TriangulateLine fails.
enum class LineTriangulationFailure {
  kTooFewViews,
  kEmptySegment,       // a segment has zero length
  kParallelPlanes,     // all planes within min_angle: the line lies in an epipolar plane
  kBehindCamera,       // an end of a segment is not in front of its camera
  kInconsistentViews,  // a residual above max_residual_sigma
  // The line goes through the centre of a camera or the world's origin.
  kSingular,
};

// A triangulated line and its residuals.
struct TriangulatedLine {
  PluckerLine line;  // in the world, directed as the first view's segment
  // Covariance of `delta` in Retract(ToOrthonormal(line), delta). It refers to the frame of the
  // line: near a line through the origin the tangent loses a dimension and the covariance grows
  // without bound.
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  double chi2 = 0;    // sum of squared end point distances over their variances
  int residuals = 0;  // number of them; chi2 has residuals - 4 degrees of freedom
};

// Finds a line from its segments in two or more views.
//
// The linear solution comes first: the two leading right singular vectors of the stacked
// interpretation planes are two planes through the line (Lee and Hwang, ICCV 2019, eq. 25, 24). It
// differs from the paper: rows are scaled to unit normals and weighted by length over sigma, and
// the origin is moved to the line, since otherwise the sum that the SVD minimises has no geometric
// meaning. Then Gauss-Newton minimises the distances of the measured end points from the
// reprojected line (eq. 13); its normal matrix gives the covariance. The paper's test m.d < 0.01 is
// met by any two planes; the reprojection into every view replaces it.
//
// Throws InputError for a view whose rotation is not a unit quaternion (UnitRotation).
//
// Cost: O(n^2) for the angle, otherwise O(n).
Expected<TriangulatedLine, LineTriangulationFailure> TriangulateLine(
    const RectifiedCamera& camera,
    std::span<const LineView> views,
    const TriangulationOptions& options = {});

}  // namespace plumbline
