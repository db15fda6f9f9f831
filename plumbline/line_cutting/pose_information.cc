// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/line_cutting/pose_information.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"

#include <limits>

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

double LogDetOf(const Eigen::LLT<Matrix6d>& factor) {
  double sum = 0;
  for (Eigen::Index i = 0; i < 6; ++i) sum += math::Log(factor.matrixLLT()(i, i));
  return 2 * sum;
}

Matrix6d WithPrior(const Matrix6d& information) {
  return information + kPriorInformation * Matrix6d::Identity();
}

}  // namespace

void InformationSums::Add(const CutResiduals& residuals) {
  weighted.noalias() += residuals.rows.transpose() * residuals.weight * residuals.rows;
  plain.noalias() += residuals.rows.transpose() * residuals.rows;
}

void InformationSums::Subtract(const CutResiduals& residuals) {
  weighted.noalias() -= residuals.rows.transpose() * residuals.weight * residuals.rows;
  plain.noalias() -= residuals.rows.transpose() * residuals.rows;
}

InformationSums SumInformation(const CuttingProblem& problem,
                               const std::vector<LineCut>& cuts,
                               CuttingInformation information) {
  PLUMBLINE_CHECK(cuts.size() == problem.lines.size(), "one cut for each line");
  InformationSums sums;
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    if (!cuts[i].used) continue;
    sums.Add(EvaluateCut(problem.camera, problem.lines[i], cuts[i], information));
  }
  return sums;
}

Matrix6d PoseInformation(const InformationSums& sums,
                         const Matrix6d& other,
                         CuttingInformation information) {
  if (information != CuttingInformation::kPrinted) return WithPrior(sums.weighted + other);
  const Eigen::LLT<Matrix6d> plain(WithPrior(sums.plain));
  const Matrix6d half = plain.solve(sums.weighted);
  return WithPrior(plain.solve(half.transpose()) + other);
}

LogDeterminant EvaluateLogDeterminant(const InformationSums& sums,
                                      const Matrix6d& other,
                                      CuttingInformation information) {
  LogDeterminant out;
  const Matrix6d omega = PoseInformation(sums, other, information);
  const Eigen::LLT<Matrix6d> factor(omega);
  if (factor.info() != Eigen::Success) {
    out.value = -std::numeric_limits<double>::infinity();
    return out;
  }
  out.value = LogDetOf(factor);
  const Matrix6d covariance = factor.solve(Matrix6d::Identity());
  if (information != CuttingInformation::kPrinted) {
    out.by_weighted = covariance;
    return out;
  }
  // This is d(A^-1 B A^-1) = A^-1 dB A^-1 - A^-1 dA S - S dA A^-1 with S = A^-1 B A^-1.
  const Matrix6d inverse_plain = WithPrior(sums.plain).llt().solve(Matrix6d::Identity());
  const Matrix6d s = inverse_plain * sums.weighted * inverse_plain;
  const Matrix6d half = s * covariance * inverse_plain;
  out.by_weighted = inverse_plain * covariance * inverse_plain;
  out.by_plain = -(half + half.transpose());
  return out;
}

Eigen::Vector2d LogDeterminant::ByRatios(const CutResiduals& residuals) const {
  const Eigen::Matrix<double, 2, 6>& j = residuals.rows;
  const Eigen::Matrix<double, 2, 6>& dj = residuals.rows_by_ratio;
  const Eigen::Matrix<double, 2, 6> weighted = residuals.weight * j * by_weighted;
  const Eigen::Matrix2d quadratic = j * by_weighted * j.transpose();
  Eigen::Vector2d gradient;
  for (int k = 0; k < 2; ++k) {
    const Eigen::Matrix2d& dw = residuals.weight_by_ratio[static_cast<std::size_t>(k)];
    gradient(k) = 2 * weighted.row(k).dot(dj.row(k)) + (dw * quadratic).trace() +
                  2 * (j.row(k) * by_plain).dot(dj.row(k));
  }
  return gradient;
}

double LogDeterminantOf(const CuttingProblem& problem,
                        const std::vector<LineCut>& cuts,
                        CuttingInformation information,
                        Eigen::VectorXd* gradient) {
  const LogDeterminant log_det = EvaluateLogDeterminant(
      SumInformation(problem, cuts, information), problem.other_information, information);
  if (gradient == nullptr) return log_det.value;
  gradient->setZero(2 * static_cast<Eigen::Index>(cuts.size()));
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    if (!cuts[i].used) continue;
    gradient->segment<2>(2 * static_cast<Eigen::Index>(i)) =
        log_det.ByRatios(EvaluateCut(problem.camera, problem.lines[i], cuts[i], information));
  }
  return log_det.value;
}

}  // namespace plumbline
