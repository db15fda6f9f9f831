// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/line_cutting/cut_residuals.h"
#include "plumbline/line_cutting/pose_information.h"

#include <array>

#include <Eigen/Core>

namespace plumbline {

// Objectives: log det of the pose information as a function of the two ratios of one line, with the
// other lines fixed (4.2), up to a constant, with its gradient. They are called with ratios in [0,
// 1]^2 in any order.

// The objective for independent information, in closed form. With z^2 j(a) = p(a), a polynomial of
// degree 2 whose coefficients are 6-vectors, and R the information of the rest,
//   log det(R + sum_k j_k j_k^T / v_k) - log det R = log det(I + [p_i^T R^-1 p_k / sqrt(V_i V_k)]),
// V = z^4 v. This is a 2 x 2 determinant of polynomials in the ratios. About 30 ns for each call.
class IndependentLineObjective {
 public:
  // `rest` is PoseInformation of the other lines and must be positive definite.
  IndependentLineObjective(const RectifiedCamera& camera,
                           const CuttableLine& line,
                           const Matrix6d& rest);

  double operator()(const Eigen::Vector2d& ratios, Eigen::Vector2d& gradient) const;

 private:
  // Powers of the ratio and variance at a ratio, with derivatives.
  struct Point {
    Eigen::Vector3d power, power_by_ratio;  // (1, a, a^2)
    double variance = 0, variance_by_ratio = 0;
  };
  Point At(double ratio) const;

  Eigen::Matrix3d gram_;  // Gram matrix of the coefficients of p in the metric R^-1
  // Coefficients of (1, a, a^2) in w^T Sigma_k w with w = z^2 g = w_0 + a w_1.
  Eigen::Vector3d start_variance_, end_variance_;
  double depth_ = 0, depth_by_ratio_ = 0, noise_ = 0;
};

// The objective for any information, by 6 x 6 matrices. About 1 us for each call, printed 3 us.
class GeneralLineObjective {
 public:
  GeneralLineObjective(const CuttingProblem& problem,
                       std::size_t line,
                       const InformationSums& rest,
                       CuttingInformation information)
      : problem_(problem), line_(line), rest_(rest), information_(information) {}

  double operator()(const Eigen::Vector2d& ratios, Eigen::Vector2d& gradient) const;

 private:
  const CuttingProblem& problem_;
  std::size_t line_;
  const InformationSums& rest_;
  CuttingInformation information_;
};

}  // namespace plumbline
