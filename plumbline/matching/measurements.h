// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/types.h"
#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/map/frame.h"
#include "plumbline/optimization/problem.h"
#include "plumbline/optimization/residuals.h"

#include <array>
#include <cstddef>
#include <optional>
#include <type_traits>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace plumbline {

// Returns the information with an added prior of standard deviation 0.5 rad for every direction of
// the tangent, which regularizes directions without information.
Eigen::Matrix4d RegularizedInformation(const Eigen::Matrix4d& information);

// A line in the world and its uncertainty, prepared for many measurements.
struct UncertainLine {
  UncertainLine(const PluckerLine& line, const Eigen::Matrix4d& information);

  PreparedLine prepared;
  Eigen::LLT<Eigen::Matrix4d> information;  // regularized
};

enum class LineWeighting { kNone, kScalar, kCovariance };

constexpr auto EnumNames(std::type_identity<LineWeighting>) {
  return std::array{std::pair{LineWeighting::kNone, "none"},
                    std::pair{LineWeighting::kScalar, "scalar"},
                    std::pair{LineWeighting::kCovariance, "covariance"}};
}

// The weights of the residuals of a line.
struct LineWeights {
  LineWeighting kind = LineWeighting::kCovariance;
  double constant_sigma_px = 1;  // deviation of each end point with weighting none

  // Also converts from a weighting alone. NOLINTNEXTLINE(google-explicit-constructor)
  LineWeights(LineWeighting of_kind, double sigma_px = 1)
      : kind(of_kind), constant_sigma_px(sigma_px) {}
};

// Returns the measurement of point feature i.
PointMeasurement MeasurePoint(const Features& features, std::size_t i);

// Returns the measurement of line feature i in the left image, or in the right one if it was found
// there. Covariance: sigma_px^2 at each end, independent (weighting none: the constant sigma).
LineMeasurement MeasureLeftLine(const Features& features,
                                std::size_t i,
                                const LineWeights& weights);
std::optional<LineMeasurement> MeasureRightLine(const Features& features,
                                                std::size_t i,
                                                const LineWeights& weights);

// Adds the uncertainty of the 3D line to the covariance of a measurement: Sigma + J Lambda^-1 J^T,
// with Lambda the information of the line's orthonormal tangent and J the derivative of the two
// residuals with respect to it at the given pose. For scalar weighting the mean of the two
// variances replaces both; for none nothing changes. A singular Lambda is regularized: directions
// without information get the standard deviation of RegularizedInformation.
void AddLandmarkUncertainty(const RectifiedCamera& camera,
                            const Rigid3& cam_from_world,
                            const PluckerLine& line,
                            const Eigen::Matrix4d& information,
                            const LineWeights& weights,
                            LineMeasurement& measurement);

// Adds the uncertainty of a line prepared for many measurements.
void AddLandmarkUncertainty(const RectifiedCamera& camera,
                            const Rigid3& cam_from_world,
                            const UncertainLine& line,
                            const LineWeights& weights,
                            LineMeasurement& measurement);

// Returns the information of line feature i of a frame about a line in the world: J^T Sigma^-1 J
// over the residuals of its left and right measurement, for the orthonormal tangent of `line`. The
// pose counts as exact.
Eigen::Matrix4d LineInformation(const RectifiedCamera& camera,
                                const Frame& frame,
                                std::size_t i,
                                const PluckerLine& line);
// Returns the information for a line prepared for many features.
Eigen::Matrix4d LineInformation(const RectifiedCamera& camera,
                                const Frame& frame,
                                std::size_t i,
                                const PreparedLine& line);

// Returns the derivative with respect to the orthonormal tangent of the point of the line at
// parameter t (PluckerLine::PointAt), restricted to its motion across the line.
Eigen::Matrix<double, 3, 4> ShiftJacobian(const PluckerLine& line,
                                          const OrthonormalLine& orthonormal,
                                          double t);

// Returns the standard deviation, in the map's scale, of the line's position at parameter t
// (PluckerLine::PointAt) in the worst direction across the line. Infinite if the information leaves
// that direction undetermined.
double SigmaAt(const PluckerLine& line, const Eigen::Matrix4d& information, double t);

}  // namespace plumbline
