// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/alignment.h"

#include "plumbline/geometry/symmetric_matrix.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/LU>
#include <Eigen/SVD>

namespace plumbline {

RotationFit FitRotation(const Eigen::Matrix3d& correlation) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(correlation,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign(1, 1, 1);
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign.z() = -1;
  return {svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose(),
          svd.singularValues().cwiseProduct(sign)};
}

namespace {

// Ratio of standard deviations below which a set of points has no second direction.
constexpr double kCollinearRatio = 1e-6;

struct Moments {
  Eigen::Vector3d source_mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d source_covariance = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d target_covariance = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();  // target source^T
};

Moments MomentsOf(std::span<const Eigen::Vector3d> source,
                  std::span<const Eigen::Vector3d> target) {
  Moments m;
  for (std::size_t i = 0; i < source.size(); ++i) {
    m.source_mean += source[i];
    m.target_mean += target[i];
  }
  const auto count = static_cast<double>(source.size());
  m.source_mean /= count;
  m.target_mean /= count;
  const double w = 1 / count;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const Eigen::Vector3d s = source[i] - m.source_mean;
    const Eigen::Vector3d t = target[i] - m.target_mean;
    m.source_covariance += w * s * s.transpose();
    m.target_covariance += w * t * t.transpose();
    m.cross += w * t * s.transpose();
  }
  return m;
}

std::optional<AlignmentFailure> DegeneracyOf(const Eigen::Matrix3d& covariance,
                                             const Eigen::Vector3d& mean) {
  const Eigen::Vector3d values = EigenvaluesOf<3>(covariance);
  const double first = std::sqrt(std::max(0.0, values(2)));
  const double second = std::sqrt(std::max(0.0, values(1)));
  // Below this ratio to the coordinates the spread is rounding error.
  if (!(first > 1e-12 * (1e-3 + mean.norm()))) return AlignmentFailure::kCoincident;
  if (!(second > kCollinearRatio * first)) return AlignmentFailure::kCollinear;
  return std::nullopt;
}

}  // namespace

Expected<Alignment, AlignmentFailure> AlignPoints(std::span<const Eigen::Vector3d> source,
                                                  std::span<const Eigen::Vector3d> target,
                                                  AlignmentScale scale) {
  PLUMBLINE_CHECK(source.size() == target.size(), "as many source as target points");
  if (source.size() < 3) return AlignmentFailure::kTooFewPoints;
  const Moments m = MomentsOf(source, target);
  if (const auto failure = DegeneracyOf(m.source_covariance, m.source_mean)) return *failure;
  if (const auto failure = DegeneracyOf(m.target_covariance, m.target_mean)) return *failure;

  const RotationFit fit = FitRotation(m.cross);
  // Sets that do not correspond may have only one direction in common.
  if (!(fit.singular_values(1) > 1e-13 * fit.singular_values(0))) {
    return AlignmentFailure::kCollinear;
  }

  Alignment result;
  Similarity3& similarity = result.target_from_source;
  similarity.rotation = Eigen::Quaterniond(fit.rotation).normalized();
  if (scale == AlignmentScale::kFree) {  // eq. 42
    similarity.scale = fit.singular_values.sum() / m.source_covariance.trace();
    // Uncorrelated sets can end with a scale that is not positive; there is no similarity then.
    if (!(similarity.scale > 0)) return AlignmentFailure::kCoincident;
  }
  similarity.translation =
      m.target_mean - similarity.scale * (similarity.rotation * m.source_mean);  // eq. 41
  double squared = 0;
  for (std::size_t i = 0; i < source.size(); ++i) {
    squared += (target[i] - similarity * source[i]).squaredNorm();
  }
  result.rmse = std::sqrt(squared / static_cast<double>(source.size()));
  return result;
}

}  // namespace plumbline
