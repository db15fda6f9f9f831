// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/optimization/problem.h"

#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Core>

namespace plumbline {

// Returns Huber's loss of a squared Mahalanobis norm s. The loss is s up to the square of the
// threshold k; from there on it is 2 k sqrt(s) - k^2, which grows like the norm itself. k =
// infinity gives plain squares.
inline double HuberLoss(double s, double k) {
  return s <= k * k ? s : 2 * k * std::sqrt(s) - k * k;
}

// Returns the derivative of HuberLoss with respect to s: the weight of the residual in the normal
// equations.
inline double HuberWeight(double s, double k) { return s <= k * k ? 1.0 : k / std::sqrt(s); }

// Thresholds of the Huber loss on the Mahalanobis norm, by kind of residual.
struct HuberThresholds {
  double point = std::numeric_limits<double>::infinity();
  double disparity = std::numeric_limits<double>::infinity();  // for points with disparity
  double line = std::numeric_limits<double>::infinity();
};

// Huber thresholds of bundle adjustment and pose estimation: the square roots of the 95 % quantiles
// of chi2 with two, three and two degrees of freedom. Larger residuals are not noise.
inline constexpr HuberThresholds kHuberThresholds{
    .point = 2.4477, .disparity = 2.7955, .line = 2.4477};

// A line in the world, prepared once for the residuals of all its measurements.
struct PreparedLine {
  explicit PreparedLine(const OrthonormalLine& line);

  Vector6d homogeneous;  // moment and direction
  // Derivative of moment and direction with respect to the orthonormal update.
  Eigen::Matrix<double, 6, 4> J_orthonormal;
};

// Least depth [map scale] of a point with a residual.
inline constexpr double kMinDepth = 1e-6;

// Residual of a point measurement, whitened, with its derivatives.
struct PointResidual {
  int rows = 2;  // 3 with disparity; unused rows are zero
  Eigen::Vector3d r =
      Eigen::Vector3d::Zero();         // column, row, disparity: (measured - predicted) / sigma
  Eigen::Matrix<double, 3, 6> J_pose;  // derivative with respect to the pose, exp([w, v]) T, eq. 20
  Eigen::Matrix3d J_point;             // derivative with respect to the point in the world
};

// Residual of a line measurement, whitened by the Cholesky factor of the inverse covariance.
struct LineResidual {
  Eigen::Vector2d r = Eigen::Vector2d::Zero();  // signed distances of start and end (eq. 13)
  Eigen::Matrix<double, 2, 6> J_pose;
  // Derivative with respect to the orthonormal update (section 3.1, eq. 16-19 corrected).
  Eigen::Matrix<double, 2, 4> J_line;
};

// Returns measured minus projected position of a point, in units of its standard deviations. The
// disparity row predicts fx * baseline / z. Returns nullopt if the point is not in front of the
// camera.
std::optional<PointResidual> EvaluatePoint(const RectifiedCamera& camera,
                                           const Rigid3& cam_from_world,
                                           const Eigen::Vector3d& point_in_world,
                                           const PointMeasurement& measurement);

// Returns the distances of the measured end points from the projected infinite line (eq. 13; eq. 16
// with the divisor l1^2 + l2^2). In the right camera the moment is m + (-baseline, 0, 0) x d.
// Returns nullopt if the line passes through the camera centre or projects to infinity.
std::optional<LineResidual> EvaluateLine(const RectifiedCamera& camera,
                                         const Rigid3& cam_from_world,
                                         const OrthonormalLine& line_in_world,
                                         const LineMeasurement& measurement);

// Returns the residual of a line in orthonormal form.
std::optional<LineResidual> EvaluateLine(const RectifiedCamera& camera,
                                         const Rigid3& cam_from_world,
                                         const PreparedLine& line_in_world,
                                         const LineMeasurement& measurement);

// Returns LineResidual::r alone.
std::optional<Eigen::Vector2d> LineDistances(const RectifiedCamera& camera,
                                             const Rigid3& cam_from_world,
                                             const PreparedLine& line_in_world,
                                             const LineMeasurement& measurement);

// Functions for the inner loops of the solvers. Measurements are prepared once. Derivatives are
// with respect to the landmark in the camera frame; the others follow from them.

// A prepared point measurement. Throws BugError if a sigma is not positive.
struct PointTerm {
  double u = 0, v = 0;
  double weight = 1;  // 1 / sigma_px
  double disparity = 0;
  double disparity_weight = 0;  // 1 / sigma; 0 without disparity
};
PointTerm MakePointTerm(const PointMeasurement& measurement);

// Whitened residual and the entries of its derivative with respect to the point in the camera frame
// that are not always zero: [ux 0 uz; 0 vy vz; 0 0 dz].
struct PointLinearization {
  Eigen::Vector3d r = Eigen::Vector3d::Zero();
  double ux = 0, uz = 0, vy = 0, vz = 0, dz = 0;
};

// Derivative of a linearized point residual with respect to the point in the camera frame.
inline Eigen::Matrix3d PointJacobian(const PointLinearization& at) {
  Eigen::Matrix3d J;
  J << at.ux, 0, at.uz, 0, at.vy, at.vz, 0, 0, at.dz;
  return J;
}

// Returns false if the point is not in front of the camera; `out` is then not set.
inline bool LinearizePoint(const RectifiedCamera& camera,
                           const PointTerm& term,
                           const Eigen::Vector3d& point_in_cam,
                           PointLinearization& out) {
  const double z = point_in_cam.z();
  if (!(z > kMinDepth)) return false;
  const double iz = 1 / z;
  const double x = point_in_cam.x() * iz;
  const double y = point_in_cam.y() * iz;
  const double fx = camera.fx * term.weight;
  const double fy = camera.fy * term.weight;
  const double d = camera.fx * camera.baseline * term.disparity_weight * iz;
  out.r = {(term.u - camera.cx) * term.weight - fx * x,
           (term.v - camera.cy) * term.weight - fy * y,
           term.disparity * term.disparity_weight - d};
  out.ux = -fx * iz;
  out.uz = -out.ux * x;
  out.vy = -fy * iz;
  out.vz = -out.vy * y;
  out.dz = d * iz;
  return true;
}

// Returns the squared norm of the whitened residual alone; nullopt if the point is not in front of
// the camera.
inline std::optional<double> PointChi2(const RectifiedCamera& camera,
                                       const PointTerm& term,
                                       const Eigen::Vector3d& point_in_cam) {
  const double z = point_in_cam.z();
  if (!(z > kMinDepth)) return std::nullopt;
  const double iz = 1 / z;
  const double ru = (term.u - camera.cx - camera.fx * point_in_cam.x() * iz) * term.weight;
  const double rv = (term.v - camera.cy - camera.fy * point_in_cam.y() * iz) * term.weight;
  const double rd = (term.disparity - camera.fx * camera.baseline * iz) * term.disparity_weight;
  return ru * ru + rv * rv + rd * rd;
}

// Returns true if a covariance of a line measurement is valid: it has a Cholesky factor.
inline bool IsPositiveDefinite(const Eigen::Matrix2d& S) {
  return S(0, 0) > 0 && S(1, 1) - S(1, 0) * S(1, 0) / S(0, 0) > 0;
}

// A prepared line measurement. Throws BugError if its covariance is not positive definite.
struct LineTerm {
  Eigen::Vector2d start = Eigen::Vector2d::Zero();
  Eigen::Vector2d end = Eigen::Vector2d::Zero();
  // Lower triangle of the inverse Cholesky factor of the covariance: whitened residual = W r.
  double w00 = 1, w10 = 0, w11 = 1;
  double shift = 0;  // x of the left camera's centre in the measuring camera: 0 or -baseline
};
LineTerm MakeLineTerm(const RectifiedCamera& camera, const LineMeasurement& measurement);

// Whitened residual and its derivative with respect to the moment in the measuring camera's frame.
struct LineLinearization {
  Eigen::Vector2d r = Eigen::Vector2d::Zero();
  Eigen::Vector3d h0 = Eigen::Vector3d::Zero();  // gradient of the first row
  Eigen::Vector3d h1 = Eigen::Vector3d::Zero();  // gradient of the second row
};

// Computes the whitened distances (eq. 13). `moment`, of any scale, is in the frame of the
// measuring camera.
inline bool WhitenedLineDistances(const RectifiedCamera& camera,
                                  const LineTerm& term,
                                  const Eigen::Vector3d& moment,
                                  Eigen::Vector2d& r) {
  const Eigen::Vector3d l = camera.ProjectMoment(moment);
  const double n2 = l.x() * l.x() + l.y() * l.y();
  if (!(n2 > 1e-24 * l.z() * l.z())) return false;
  const double scale = 1 / std::sqrt(n2);
  const double r0 = (l.x() * term.start.x() + l.y() * term.start.y() + l.z()) * scale;
  const double r1 = (l.x() * term.end.x() + l.y() * term.end.y() + l.z()) * scale;
  r = {term.w00 * r0, term.w10 * r0 + term.w11 * r1};
  return true;
}

// Returns false if the image line is not defined; `out` is then not set.
inline bool LinearizeLine(const RectifiedCamera& camera,
                          const LineTerm& term,
                          const Eigen::Vector3d& moment,
                          LineLinearization& out) {
  const Eigen::Vector3d l = camera.ProjectMoment(moment);
  const double n2 = l.x() * l.x() + l.y() * l.y();
  if (!(n2 > 1e-24 * l.z() * l.z())) return false;
  const double scale = 1 / std::sqrt(n2);
  const Eigen::Vector2d n(l.x() * scale, l.y() * scale);
  const double c = l.z() * scale;
  const double r0 = n.dot(term.start) + c;
  const double r1 = n.dot(term.end) + c;
  // eq. 16 with the divisor l1^2 + l2^2: dr/d(l1, l2) = (x - n r) / |l12|, dr/dl3 = 1 / |l12|.
  const Eigen::Vector2d g0 = (term.start - r0 * n) * scale;
  const Eigen::Vector2d g1 = (term.end - r1 * n) * scale;
  // eq. 17: transpose of the line projection matrix of eq. 8.
  const double f = camera.fx * camera.fy * scale;
  const Eigen::Vector3d h0(
      camera.fy * (g0.x() - camera.cx * scale), camera.fx * (g0.y() - camera.cy * scale), f);
  const Eigen::Vector3d h1(
      camera.fy * (g1.x() - camera.cx * scale), camera.fx * (g1.y() - camera.cy * scale), f);
  out.r = {term.w00 * r0, term.w10 * r0 + term.w11 * r1};
  out.h0 = term.w00 * h0;
  out.h1 = term.w10 * h0 + term.w11 * h1;
  return true;
}

// Returns the row of the derivative with respect to exp([w, v]) T of a residual with gradient h at
// the moment (eq. 20). A rotation and translation of the left camera change its moment m and
// direction d by w x m + v x d and w x d; the right camera's moment is m + shift e_x x d. `moment`
// is that of LinearizeLine.
inline Vector6d LinePoseRow(const Eigen::Vector3d& h,
                            const Eigen::Vector3d& moment,
                            const Eigen::Vector3d& direction,
                            double shift) {
  const Eigen::Vector3d dh = direction.cross(h);
  Vector6d row;
  // With e = (shift, 0, 0) and Jacobi's identity e x (w x d) = (e x w) x d + w x (e x d), the turn
  // contributes h . (w x moment) + h . ((e x w) x d) = w . (moment x h + dh x e).
  row << moment.cross(h) + Eigen::Vector3d(0, shift * dh.z(), -shift * dh.y()), dh;
  return row;
}

// A measurement of a point whose position has a covariance.
struct UncertainPointTerm {
  PointTerm term;             // its weights are one, so that residuals are in pixels
  Eigen::Matrix3d whitening;  // whitens these residuals; lower triangular
};

// Returns the term of a point measurement at the given pose. The covariance of the residual is that
// of the measurement plus that of the point's projection, S = diag(sigma^2) + J Sigma J^T; its
// inverse Cholesky factor whitens. Returns nullopt if the point has no covariance (zero), is not in
// front of the camera, or is so near that S is singular to working precision.
//
//   point_covariance  of the position in the world, map scale squared; positive semidefinite
std::optional<UncertainPointTerm> MakeUncertainPointTerm(const RectifiedCamera& camera,
                                                         const Rigid3& cam_from_world,
                                                         const Eigen::Vector3d& point_in_world,
                                                         const Eigen::Matrix3d& point_covariance,
                                                         const PointMeasurement& measurement);

// Returns residual and derivatives of a match at a pose, whitened with the covariance of
// measurement and point there. Returns nullopt if the point is not in front of the camera, or so
// near that its covariance is singular to working precision.
std::optional<PointResidual> EvaluateMatch(const RectifiedCamera& camera,
                                           const Rigid3& cam_from_world,
                                           const PoseProblem::PointMatch& match);

}  // namespace plumbline
