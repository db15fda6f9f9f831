// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/uncertain_line.h"
#include "plumbline/base/options.h"
#include "plumbline/features/types.h"
#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/optimization/line_parametrization.h"
#include "plumbline/optimization/problem.h"

#include <array>
#include <cstddef>
#include <optional>
#include <type_traits>
#include <utility>

#include <Eigen/Core>

namespace plumbline {

enum class LineWeighting { kNone, kScalar, kCovariance };
enum class LineReconstruction { kNView, kTwoView };

constexpr auto EnumNames(std::type_identity<LineWeighting>) {
  return std::array{std::pair{LineWeighting::kNone, "none"},
                    std::pair{LineWeighting::kScalar, "scalar"},
                    std::pair{LineWeighting::kCovariance, "covariance"}};
}
constexpr auto EnumNames(std::type_identity<LineReconstruction>) {
  return std::array{std::pair{LineReconstruction::kNView, "n_view"},
                    std::pair{LineReconstruction::kTwoView, "two_view"}};
}

// What the residuals of a line weigh.
struct LineWeights {
  LineWeighting kind = LineWeighting::kCovariance;
  double constant_sigma_px = 1;  // of each end point, with none

  // Also of a weighting alone. NOLINTNEXTLINE(google-explicit-constructor)
  LineWeights(LineWeighting of_kind, double sigma_px = 1)
      : kind(of_kind), constant_sigma_px(sigma_px) {}
};

// How lines are made from several views and enter all optimization.
struct LineOptions {
  LineParametrization parametrization = LineParametrization::kPlucker;
  LineResidualKind residual = LineResidualKind::kObservedEnds;
  LineReconstruction reconstruction = LineReconstruction::kNView;
  LineWeighting weighting = LineWeighting::kCovariance;
  double constant_sigma_px = 1;
  double min_length_ratio = 0.3;
  bool rotation_gate = false;

  LineWeights weights() const { return {weighting, constant_sigma_px}; }
};

template <class Visitor>
void VisitFields(Visitor&& visit, LineOptions& o) {
  visit("parametrization",
        o.parametrization,
        "of a line in bundle adjustment: plucker (orthonormal form, 4 parameters), plucker_left "
        "(the same, turned about the axes of the frame), endpoints (two points, 6)");
  visit("residual",
        o.residual,
        "observed_ends: distances of the measured end points from the projected line; "
        "projected_ends: of the projected end points from the measured line");
  visit("reconstruction",
        o.reconstruction,
        "of a line from several keyframes: n_view (all closest ones together, pairs where they "
        "disagree), two_view (the closest pair that agrees)");
  visit("weighting",
        o.weighting,
        "of the two residuals of a line: none (constant_sigma_px each), scalar (their mean "
        "variance), "
        "covariance (2 x 2, with the uncertainty of the 3D line in tracking)");
  visit("constant_sigma_px",
        o.constant_sigma_px,
        "deviation of the residuals of all lines where weighting is none [px]",
        Range{0.01, 10});
  visit("min_length_ratio",
        o.min_length_ratio,
        "shorter over longer of two lines that are matched by their looks, between keyframes and "
        "where no pose is predicted (the first paper: 0.8)",
        Range{0, 1});
  visit("rotation_gate",
        o.rotation_gate,
        "lines of two keyframes are matched only where their directions in the images differ by no "
        "more than the keyframes are turned against each other (as the first paper)");
}

// The measurement of point feature i.
PointMeasurement MeasurePoint(const Features& features, std::size_t i);

// The measurement of line feature i in the left image, and in the right one if it was found there.
// Covariance: sigma_px^2 at each end, independent (weighting none: the constant sigma).
LineMeasurement MeasureLeftLine(const Features& features,
                                std::size_t i,
                                const LineWeights& weights);
std::optional<LineMeasurement> MeasureRightLine(const Features& features,
                                                std::size_t i,
                                                const LineWeights& weights);

// Adds to the covariance of a measurement what the uncertainty of the 3D line makes of it:
// Sigma + J Lambda^-1 J^T, with Lambda the information of the line's orthonormal tangent and J the
// derivative of the two residuals by it at the given pose. For scalar weighting the mean of the two
// variances replaces both; for none nothing changes. A singular Lambda is regularized: directions
// without information get the standard deviation of RegularizedInformation.
void AddLandmarkUncertainty(const RectifiedCamera& camera,
                            const Rigid3& cam_from_world,
                            const PluckerLine& line,
                            const Eigen::Matrix4d& information,
                            const LineWeights& weights,
                            LineMeasurement& measurement);

// The same with a line that was prepared for many measurements.
void AddLandmarkUncertainty(const RectifiedCamera& camera,
                            const Rigid3& cam_from_world,
                            const UncertainLine& line,
                            const LineWeights& weights,
                            LineMeasurement& measurement);

// Makes a measurement serve residuals that are the distances of the projected ends (in the world,
// on the line) from the measured line: first the covariance that the measured line gives them
// (ProjectedEndsCovariance), then, with information, what the uncertainty of the 3D line adds. For
// scalar weighting the mean of the two variances; for none nothing changes.
void UseProjectedEnds(const RectifiedCamera& camera,
                      const Rigid3& cam_from_world,
                      const PluckerLine& line,
                      const Segment3& ends,
                      const std::optional<Eigen::Matrix4d>& information,
                      const LineWeights& weights,
                      LineMeasurement& measurement);

}  // namespace plumbline
