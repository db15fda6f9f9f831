// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/alignment.h"

#include "plumbline/geometry/eigenpairs.h"
#include "plumbline/geometry/rotation_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace plumbline {
namespace {

// Ratio of standard deviations below which a set of points has no second direction.
constexpr double kCollinearRatio = 1e-6;

struct Moments {
  double weight = 0;
  std::size_t used = 0;
  Eigen::Vector3d source_mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d source_covariance = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d target_covariance = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();  // target source^T
};

double WeightOf(std::span<const double> weights, std::size_t i) {
  return weights.empty() ? 1.0 : weights[i];
}

Moments MomentsOf(std::span<const Eigen::Vector3d> source,
                  std::span<const Eigen::Vector3d> target,
                  std::span<const double> weights) {
  Moments m;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const double w = WeightOf(weights, i);
    if (w <= 0) continue;
    m.weight += w;
    ++m.used;
    m.source_mean += w * source[i];
    m.target_mean += w * target[i];
  }
  if (m.used == 0) return m;
  m.source_mean /= m.weight;
  m.target_mean /= m.weight;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const double w = WeightOf(weights, i) / m.weight;
    if (w <= 0) continue;
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
                                                  AlignmentScale scale,
                                                  std::span<const double> weights) {
  PLUMBLINE_CHECK(source.size() == target.size(), "as many source as target points");
  PLUMBLINE_CHECK(weights.empty() || weights.size() == source.size(), "a weight for each point");
  const Moments m = MomentsOf(source, target, weights);
  if (m.used < 3) return AlignmentFailure::kTooFewPoints;
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
    squared += WeightOf(weights, i) * (target[i] - similarity * source[i]).squaredNorm();
  }
  result.rmse = std::sqrt(squared / m.weight);
  return result;
}

}  // namespace plumbline
