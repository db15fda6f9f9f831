// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/geometry/trimming.h"
#include "plumbline/optimization/problem.h"
#include "plumbline/optimization/residuals.h"

#include <optional>

#include <Eigen/Core>

namespace plumbline {

// The residual of LineResidualKind::kProjectedEnds (second paper, eq. 1): signed distances of the
// projected ends of a 3D segment from the infinite line through the measured segment. It needs ends
// in 3D; the residual of eq. 13 of the first paper is the reverse and does not.

// A precomputed line measurement.
struct ProjectedEndsTerm {
  // The distance of a point X of the measuring camera is line . X / X.z, in pixels. Zero for a
  // measurement without direction, which has no residual.
  Eigen::Vector3d line = Eigen::Vector3d::Zero();
  double w00 = 1, w10 = 0, w11 = 1;  // as in LineTerm
  double shift = 0;                  // as in LineTerm
};
ProjectedEndsTerm MakeProjectedEndsTerm(const RectifiedCamera& camera,
                                        const LineMeasurement& measurement);

// Whitened residual and its derivatives with respect to the two ends in the camera: the first row
// depends only on the start.
struct ProjectedEndsLinearization {
  Eigen::Vector2d r = Eigen::Vector2d::Zero();
  Eigen::Vector3d h0 = Eigen::Vector3d::Zero();        // first row by the start
  Eigen::Vector3d h1_start = Eigen::Vector3d::Zero();  // second row by the start
  Eigen::Vector3d h1_end = Eigen::Vector3d::Zero();    // second row by the end
};

// `ends` in the left camera's frame. Returns false if an end is not in front of the camera; `out`
// is then not set.
bool LinearizeProjectedEnds(const ProjectedEndsTerm& term,
                            const Segment3& ends,
                            ProjectedEndsLinearization& out);

// The whitened residual alone; false as above.
bool WhitenedEndDistances(const ProjectedEndsTerm& term, const Segment3& ends, Eigen::Vector2d& r);

// Rows of the derivative with respect to exp([w, v]) T of the left camera (eq. 20): each end moves
// by w x X + v.
struct ProjectedEndsPoseRows {
  Vector6d a, b;
};
ProjectedEndsPoseRows PoseRows(const ProjectedEndsLinearization& lin, const Segment3& ends);

// d(ends) / d(m, d) of the points at the parameters of `interval` on a line (PluckerLine::PointAt)
// with the homogeneous coordinates (m, d) of any scale: start in the first three rows.
Matrix6d EndsJacobian(const Vector6d& homogeneous, const LineInterval& interval);

// Residual with derivatives; J_line by the orthonormal update (Retract), with constant parameters
// of the ends along the line. nullopt if an end is not in front of the camera.
std::optional<LineResidual> EvaluateProjectedEnds(const RectifiedCamera& camera,
                                                  const Rigid3& cam_from_world,
                                                  const OrthonormalLine& line_in_world,
                                                  const LineInterval& interval,
                                                  const LineMeasurement& measurement);

// Covariance of the two residuals that follows from the covariance of the distances of the measured
// ends (measurement.covariance): the measured line passes the projected ends at s_0 and s_1 (0 its
// start, 1 its end), where its error is (1 - s) times the error of its start plus s times that of
// its end. Ends far outside of the measured segment thus have little weight. Regular also if both
// ends coincide. `ends` in the world. Returns the measured covariance if an end is not in front of
// the camera.
Eigen::Matrix2d ProjectedEndsCovariance(const RectifiedCamera& camera,
                                        const Rigid3& cam_from_world,
                                        const Segment3& ends,
                                        const LineMeasurement& measurement);

}  // namespace plumbline
