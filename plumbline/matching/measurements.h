// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/types.h"
#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/matching/uncertain_line.h"
#include "plumbline/optimization/problem.h"

#include <array>
#include <cstddef>
#include <optional>
#include <type_traits>
#include <utility>

#include <Eigen/Core>

namespace plumbline {

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

}  // namespace plumbline
