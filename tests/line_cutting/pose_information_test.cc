// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/line_cutting/pose_information.h"

#include "tests/line_cutting/random_lines.h"
#include <cmath>

#include <Eigen/LU>
#include <Eigen/QR>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::MatrixXd;

constexpr std::array kAll = {CuttingInformation::kIndependent,
                             CuttingInformation::kPrinted,
                             CuttingInformation::kCorrelated};

double LogDet(const Matrix6d& m) { return std::log(m.determinant()); }

// J, G = l^T H_L and the covariance of all ends, stacked as in the paper.
struct Stacked {
  MatrixXd rows, by_ends, covariance;
};
Stacked StackAtFullLength(const CuttingProblem& problem) {
  const auto n = static_cast<Eigen::Index>(problem.lines.size());
  Stacked out{MatrixXd::Zero(2 * n, 6), MatrixXd::Zero(2 * n, 6 * n), MatrixXd::Zero(6 * n, 6 * n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const CuttableLine& line = problem.lines[static_cast<std::size_t>(i)];
    for (int e = 0; e < 2; ++e) {
      const CutResidual r = EvaluateCutPoint(problem.camera, line, e);
      const Eigen::Index row = 2 * i + e;
      out.rows.row(row) = r.pose_row.transpose();
      out.by_ends.block<1, 3>(row, 3 * row) = r.gradient.transpose();
      out.covariance.block<3, 3>(3 * row, 3 * row) =
          e == 0 ? line.start_covariance : line.end_covariance;
    }
  }
  return out;
}

Matrix6d InformationOf(const CuttingProblem& problem,
                       const std::vector<LineCut>& cuts,
                       CuttingInformation information) {
  return PoseInformation(
      SumInformation(problem, cuts, information), problem.other_information, information);
}

TEST(PoseInformation, PrintedIsEquation5AndIndependentThatOfAWeightedSolver) {
  const CuttingProblem problem = RandomProblem(1, 8, 3);
  const Stacked s = StackAtFullLength(problem);
  const std::vector<LineCut> full(8);
  // eq. 4 and 5 as they stand: H^T = (l^T H_x)^+ l^T H_L, Omega = H^T Omega_L H.
  const MatrixXd h = s.rows.completeOrthogonalDecomposition().pseudoInverse() * s.by_ends;
  const Matrix6d printed = h * s.covariance.inverse() * h.transpose();
  EXPECT_LT((InformationOf(problem, full, CuttingInformation::kPrinted) - printed).norm(),
            1e-5 * printed.norm());
  MatrixXd noise = s.by_ends * s.covariance * s.by_ends.transpose();
  noise.diagonal().array() += 1;
  const Matrix6d weighted = s.rows.transpose() * noise.inverse() * s.rows;
  EXPECT_LT((InformationOf(problem, full, CuttingInformation::kIndependent) - weighted).norm(),
            1e-9 * weighted.norm());
}

TEST(PoseInformation, PrintedFallsWhenEveryLineIsGivenTwice) {
  CuttingProblem problem = RandomProblem(2, 8);
  const std::vector<LineCut> once(8), twice(16);
  CuttingProblem doubled = problem;
  doubled.lines.insert(doubled.lines.end(), problem.lines.begin(), problem.lines.end());
  const double six_ln_2 = 6 * std::log(2.0);
  EXPECT_NEAR(LogDeterminantOf(doubled, twice, CuttingInformation::kIndependent) -
                  LogDeterminantOf(problem, once, CuttingInformation::kIndependent),
              six_ln_2,
              1e-3);
  EXPECT_NEAR(LogDeterminantOf(doubled, twice, CuttingInformation::kPrinted) -
                  LogDeterminantOf(problem, once, CuttingInformation::kPrinted),
              -six_ln_2,
              1e-3);
}

TEST(PoseInformation, OfPointsIsAddedAsItIs) {
  CuttingProblem problem = RandomProblem(3, 5);
  const std::vector<LineCut> cuts(5, {0.3, 0.8});
  for (const CuttingInformation kind : kAll) {
    problem.other_information.setZero();
    const Matrix6d lines = InformationOf(problem, cuts, kind);
    problem.other_information = 1e4 * Matrix6d::Identity();
    const Matrix6d both = InformationOf(problem, cuts, kind);
    EXPECT_LT((both - lines - problem.other_information).norm(), 1e-9 * both.norm());
  }
}

TEST(PoseInformation, CorrelatedIsTheSameForEveryCut) {
  const CuttingProblem problem = RandomProblem(4, 6);
  const Matrix6d full =
      InformationOf(problem, std::vector<LineCut>(6), CuttingInformation::kCorrelated);
  for (const LineCut& cut : {LineCut{0.2, 0.8}, LineCut{0.4, 0.6}, LineCut{0.49, 0.51}}) {
    const Matrix6d found =
        InformationOf(problem, std::vector<LineCut>(6, cut), CuttingInformation::kCorrelated);
    EXPECT_LT((found - full).norm(), 1e-7 * full.norm());
  }
  // One point is one residual: less.
  const Matrix6d point =
      InformationOf(problem, std::vector<LineCut>(6, {0.5, 0.5}), CuttingInformation::kCorrelated);
  EXPECT_LT(LogDet(point), LogDet(full) - 1);
}

TEST(PoseInformation, IsPositiveDefiniteForFewLines) {
  for (const auto kind : {CuttingInformation::kIndependent, CuttingInformation::kCorrelated}) {
    for (int lines = 0; lines < 3; ++lines) {
      const CuttingProblem problem = RandomProblem(5, lines);
      const std::vector<LineCut> cuts(static_cast<std::size_t>(lines));
      EXPECT_TRUE(std::isfinite(LogDeterminantOf(problem, cuts, kind))) << NameOf(kind) << lines;
    }
  }
}

TEST(LogDeterminant, GradientAgreesWithDifferences) {
  for (const CuttingInformation kind : kAll) {
    CuttingProblem problem = RandomProblem(6, 7, 5);
    Matrix6d points = 1e3 * Matrix6d::Identity();
    points.diagonal().head<3>().setConstant(1e5);
    problem.other_information = points;
    Rng rng(7);
    std::vector<LineCut> cuts(7);
    for (LineCut& cut : cuts) cut = {rng.Uniform(0.05, 0.45), rng.Uniform(0.55, 0.95)};
    Eigen::VectorXd gradient;
    LogDeterminantOf(problem, cuts, kind, &gradient);
    for (std::size_t i = 0; i < cuts.size(); ++i) {
      for (const bool second : {false, true}) {
        const auto at = [&](double offset) {
          std::vector<LineCut> moved = cuts;
          (second ? moved[i].second : moved[i].first) += offset;
          return LogDeterminantOf(problem, moved, kind);
        };
        const double h = 1e-4;
        const double numeric = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
        const auto k = 2 * static_cast<Eigen::Index>(i) + (second ? 1 : 0);
        EXPECT_NEAR(gradient(k), numeric, 1e-8 + 1e-6 * std::abs(numeric)) << NameOf(kind);
      }
    }
  }
}

}  // namespace
}  // namespace plumbline
