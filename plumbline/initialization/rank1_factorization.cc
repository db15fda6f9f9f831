// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/rank1_factorization.h"

#include "plumbline/base/error.h"
#include "plumbline/base/median.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace plumbline {
namespace {

// From the median of the length of a residual with two independent normal parts to their deviation.
constexpr double kMedianToSigma = 1 / 1.1774;
// Of what the noise was said to be: where the residuals are smaller still, none is an outlier.
constexpr double kMinSpread = 0.1;

// |entry - centre * inverse distance| in standard deviations, by view and point; unknown ones -1.
Eigen::MatrixXd Residuals(const Rank1Matrix& matrix, const RankOne& pair) {
  const Eigen::MatrixXd& weights = matrix.weights();
  Eigen::MatrixXd residuals(weights.rows(), weights.cols());
  for (Eigen::Index k = 0; k < weights.cols(); ++k) {
    for (Eigen::Index i = 0; i < weights.rows(); ++i) {
      const Eigen::Vector3d error = matrix.entries().col(k).segment<3>(3 * i) -
                                    pair.centres.segment<3>(3 * i) * pair.inverse_distances(k);
      const double weight = weights(i, k);
      residuals(i, k) = weight > 0 ? error.norm() * std::sqrt(weight) : -1;
    }
  }
  return residuals;
}

double Spread(const Eigen::MatrixXd& residuals) {
  std::vector<double> known;
  known.reserve(static_cast<std::size_t>(residuals.size()));
  for (Eigen::Index j = 0; j < residuals.size(); ++j) {
    if (residuals.data()[j] >= 0) known.push_back(residuals.data()[j]);
  }
  return known.empty() ? 0 : UpperMedian(known) * kMedianToSigma;
}

// Weights of the entries by their noise and by the Cauchy loss of their residuals.
Eigen::MatrixXd Reweighted(const Eigen::MatrixXd& weights,
                           const Eigen::MatrixXd& residuals,
                           double width) {
  return weights.array() / (1 + (residuals.array() / width).square());
}

// The inverse distances for given centres.
void SolvePoints(const Eigen::MatrixXd& entries, const Eigen::MatrixXd& weights, RankOne& pair) {
  for (Eigen::Index k = 0; k < entries.cols(); ++k) {
    double numerator = 0;
    double denominator = 0;
    for (Eigen::Index i = 0; i < weights.rows(); ++i) {
      const auto centre = pair.centres.segment<3>(3 * i);
      numerator += weights(i, k) * centre.dot(entries.col(k).segment<3>(3 * i));
      denominator += weights(i, k) * centre.squaredNorm();
    }
    pair.inverse_distances(k) = denominator > 0 ? numerator / denominator : 0;
  }
}

// The centres for given inverse distances, then scaled to unit length in all.
void SolveCentres(const Eigen::MatrixXd& entries, const Eigen::MatrixXd& weights, RankOne& pair) {
  for (Eigen::Index i = 0; i < weights.rows(); ++i) {
    Eigen::Vector3d numerator = Eigen::Vector3d::Zero();
    double denominator = 0;
    for (Eigen::Index k = 0; k < entries.cols(); ++k) {
      const double d = pair.inverse_distances(k);
      numerator += weights(i, k) * d * entries.col(k).segment<3>(3 * i);
      denominator += weights(i, k) * d * d;
    }
    pair.centres.segment<3>(3 * i) =
        denominator > 0 ? Eigen::Vector3d(numerator / denominator) : Eigen::Vector3d::Zero();
  }
  const double length = pair.centres.norm();
  if (length > 0) pair.centres /= length;
}

// Most points are in front of the camera: the sign that an SVD leaves open.
void FixSign(RankOne& pair) {
  const auto negative = (pair.inverse_distances.array() < 0).count();
  const auto positive = (pair.inverse_distances.array() > 0).count();
  if (negative <= positive) return;
  pair.centres = -pair.centres;
  pair.inverse_distances = -pair.inverse_distances;
}

// The unweighted solution of the matrix with its columns scaled by what they are worth (which
// leaves it rank one), so that rays near the epipole do not drown the others.
RankOne StartingPair(const Rank1Matrix& matrix) {
  const Eigen::RowVectorXd worth = matrix.weights().colwise().mean().cwiseSqrt();
  RankOne pair = LeadingPair(matrix.entries() * worth.asDiagonal());
  SolvePoints(matrix.entries(), matrix.weights(), pair);
  return pair;
}

Rank1Solution ToSolution(const RankOne& pair, double spread) {
  Rank1Solution solution;
  for (Eigen::Index i = 0; i < pair.centres.size(); i += 3) {
    solution.centres.emplace_back(pair.centres.segment<3>(i));
  }
  solution.inverse_distances.assign(pair.inverse_distances.begin(), pair.inverse_distances.end());
  for (const double d : solution.inverse_distances) {
    solution.in_front += d > 0 ? 1 : 0;
    solution.solved += d != 0 ? 1 : 0;
  }
  solution.spread = spread;
  return solution;
}

}  // namespace

Rank1Matrix::Rank1Matrix(std::span<const Eigen::Vector2d> reference_points,
                         std::span<const Rank1View> views,
                         double min_epipole_angle) {
  const auto n = static_cast<Eigen::Index>(reference_points.size());
  const auto m = static_cast<Eigen::Index>(views.size());
  entries_ = Eigen::MatrixXd::Zero(3 * m, n);
  weights_ = Eigen::MatrixXd::Zero(m, n);
  Eigen::Matrix3Xd rays(3, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    rays.col(k) = reference_points[static_cast<std::size_t>(k)].homogeneous().normalized();
  }
  const double min_squared_sine = std::pow(std::sin(min_epipole_angle), 2);
  for (Eigen::Index i = 0; i < m; ++i) {
    const Rank1View& view = views[static_cast<std::size_t>(i)];
    PLUMBLINE_CHECK(view.points.size() == reference_points.size() &&
                        view.sigmas.size() == reference_points.size(),
                    "one place and one sigma for each point");
    const Eigen::Matrix3d turn = view.reference_from_cam.toRotationMatrix();
    const Eigen::Vector3d& t = view.centre_direction;
    for (Eigen::Index k = 0; k < n; ++k) {
      const double sigma = view.sigmas[static_cast<std::size_t>(k)];
      if (!(sigma > 0)) continue;
      const Eigen::Vector3d q =
          turn * view.points[static_cast<std::size_t>(k)].homogeneous().normalized();
      const double c = t.dot(q);
      const double squared_sine = 1 - c * c;
      if (!(squared_sine > min_squared_sine)) continue;  // the two lines are parallel (E1, eq. 3)
      const Eigen::Vector3d p = rays.col(k);
      const double s0 = (t.dot(p) - c * q.dot(p)) / squared_sine;
      const double s = (q.dot(p) - c * t.dot(p)) / squared_sine;
      entries_.col(k).segment<3>(3 * i) = 0.5 * (s0 * t + p - s * q);
      weights_(i, k) = squared_sine / (sigma * sigma);
    }
  }
}

RankOne LeadingPair(const Eigen::MatrixXd& entries) {
  const Eigen::MatrixXd gram = entries * entries.transpose();
  // The column with the most in it is not orthogonal to what is sought.
  Eigen::Index start = 0;
  gram.diagonal().maxCoeff(&start);
  Eigen::VectorXd u = gram.col(start);
  const double length = u.norm();
  if (length > 0) u /= length;
  constexpr int kMaxIterations = 100;
  for (int i = 0; i < kMaxIterations; ++i) {
    Eigen::VectorXd next = gram * u;
    const double norm = next.norm();
    if (!(norm > 0)) break;
    next /= norm;
    const double change = (next - u).norm();
    u = next;
    if (change < 1e-13) break;
  }
  RankOne pair{u, entries.transpose() * u};
  FixSign(pair);
  return pair;
}

std::optional<Rank1Solution> FactorizeRank1(std::span<const Eigen::Vector2d> reference_points,
                                            std::span<const Rank1View> views,
                                            const Rank1Options& options) {
  if (views.empty() || reference_points.empty()) return std::nullopt;
  const Rank1Matrix matrix(reference_points, views, options.min_epipole_angle);
  const Eigen::MatrixXd& weights = matrix.weights();
  if ((weights.colwise().maxCoeff().array() > 0).count() < 3) return std::nullopt;
  if (!(weights.rowwise().maxCoeff().minCoeff() > 0)) return std::nullopt;
  RankOne pair = StartingPair(matrix);
  Eigen::MatrixXd residuals = Residuals(matrix, pair);
  for (int i = 0; i < options.iterations; ++i) {
    const Eigen::MatrixXd reweighted = Reweighted(
        weights, residuals, options.loss_width * std::max(kMinSpread, Spread(residuals)));
    SolvePoints(matrix.entries(), reweighted, pair);
    SolveCentres(matrix.entries(), reweighted, pair);
    SolvePoints(matrix.entries(), reweighted, pair);
    residuals = Residuals(matrix, pair);
  }
  FixSign(pair);
  for (Eigen::Index k = 0; k < weights.cols(); ++k) {
    if (!(weights.col(k).maxCoeff() > 0)) pair.inverse_distances(k) = 0;
  }
  return ToSolution(pair, Spread(residuals));
}

}  // namespace plumbline
