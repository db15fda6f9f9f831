// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/line_cutting/cut_residuals.h"
#include "plumbline/line_cutting/cutting_problem.h"

#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Sums over the residuals of lines.
struct InformationSums {
  Matrix6d weighted = Matrix6d::Zero();  // sum of rows^T weight rows
  // Sum of rows^T rows; only the printed information uses it.
  Matrix6d plain = Matrix6d::Zero();

  void Add(const CutResiduals& residuals);
  void Subtract(const CutResiduals& residuals);
};
// Sums over the lines in use.
InformationSums SumInformation(const CuttingProblem& problem,
                               const std::vector<LineCut>& cuts,
                               CuttingInformation information);

// Returns the information of the pose (6 x 6, left perturbation [rotation, translation]), including
// the other measurements and kPriorInformation. B = sums.weighted, A = sums.plain:
//   independent, correlated   B + other: Omega = J^T C^-1 J of a solver that weights
//   printed                   A^-1 B A^-1 + other: eq. 5 with H^T = (l^T H_x)^+ l^T H_L of eq. 4,
//                             where (l^T H_x)^+ = A^-1 J^T over all lines. This is not an
//                             information: repeated lines lower it.
Matrix6d PoseInformation(const InformationSums& sums,
                         const Matrix6d& other,
                         CuttingInformation information);

// log det of PoseInformation (eq. 7), with its derivatives with respect to the sums: d value =
// tr(by_weighted dB) + tr(by_plain dA). It is -infinity if the information is not positive
// definite; the derivatives are then zero.
struct LogDeterminant {
  double value = 0;
  Matrix6d by_weighted = Matrix6d::Zero();
  Matrix6d by_plain = Matrix6d::Zero();

  // Returns the derivatives with respect to the two ratios of a line with these residuals:
  // tr(Omega^-1 dOmega/da).
  Eigen::Vector2d ByRatios(const CutResiduals& residuals) const;
};
LogDeterminant EvaluateLogDeterminant(const InformationSums& sums,
                                      const Matrix6d& other,
                                      CuttingInformation information);

// Returns log det for the cuts of all lines, and its gradient with respect to first and second
// ratio of each line in turn (2n numbers; zeros for lines not in use).
double LogDeterminantOf(const CuttingProblem& problem,
                        const std::vector<LineCut>& cuts,
                        CuttingInformation information,
                        Eigen::VectorXd* gradient = nullptr);

}  // namespace plumbline
