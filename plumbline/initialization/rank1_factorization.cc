// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/rank1_factorization.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"
#include "plumbline/base/statistics.h"
#include "plumbline/geometry/se3.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace plumbline {
namespace {

// Factor from the median length of a residual with two independent normal components to their
// deviation.
constexpr double kMedianToSigma = 1 / 1.1774;
// Least spread of the residuals, in units of the assumed noise. If residuals are still smaller,
// none is an outlier.
constexpr double kMinSpread = 0.1;

using Row = Eigen::Array<double, 1, Eigen::Dynamic>;
using Rows = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Measures the deviation of residuals by their median. It takes a sample of 300 to 600 entries,
// spread over all that have a weight, with other points in each view. More entries would improve it
// by a few percent only.
class SpreadOfKnown {
 public:
  explicit SpreadOfKnown(const Rank1Rows& weights) {
    constexpr std::size_t kEnough = 300;
    const std::span known(weights.data(), static_cast<std::size_t>(weights.size()));
    const auto count = static_cast<std::size_t>((weights.array() > 0).count());
    const std::size_t step = std::max<std::size_t>(1, count / kEnough);
    for (std::size_t j = 0, met = 0; j < known.size(); ++j) {
      if (!(known[j] > 0)) continue;
      const std::size_t view = j / static_cast<std::size_t>(weights.cols());
      if ((met++ + view) % step == 0) sample_.push_back(j);
    }
    values_.resize(sample_.size());
  }

  double operator()(const Rows& squared_residuals) {
    if (sample_.empty()) return 0;
    for (std::size_t j = 0; j < sample_.size(); ++j) {
      values_[j] = squared_residuals.data()[sample_[j]];
    }
    return std::sqrt(UpperMedian(std::span(values_))) * kMedianToSigma;
  }

 private:
  std::vector<std::size_t> sample_;  // indices of the sampled entries, which have a weight
  std::vector<double> values_;
};

// The coordinates of points, each in a row.
struct CoordinateRows {
  Row x, y;

  explicit CoordinateRows(std::span<const Eigen::Vector2d> points)
      : x(points.size()), y(points.size()) {
    for (std::size_t k = 0; k < points.size(); ++k) {
      x(static_cast<Eigen::Index>(k)) = points[k].x();
      y(static_cast<Eigen::Index>(k)) = points[k].y();
    }
  }
};

// Solves for points and cameras in turn by weighted least squares (eq. 5). Sums that both steps
// need are kept.
class Alternation {
 public:
  Alternation(const Rank1Matrix& matrix, const Eigen::VectorXd& centres)
      : entries_(matrix.entries().array()),
        weights_(matrix.weights().array()),
        squares_(weights_.rows(), weights_.cols()),
        along_(weights_.rows(), weights_.cols()),
        reweighted_(weights_),
        numerator_(weights_.cols()),
        denominator_(weights_.cols()),
        pair_{centres, Eigen::VectorXd(weights_.cols())} {
    for (Eigen::Index i = 0; i < weights_.rows(); ++i) {
      squares_.row(i) = entries_.row(3 * i).square() + entries_.row(3 * i + 1).square() +
                        entries_.row(3 * i + 2).square();
    }
    SetAlong();
    SolvePoints();
  }

  RankOne& pair() { return pair_; }

  // Does one step under the Cauchy loss.
  void Step(const Rows& squared_residuals, double width) {
    reweighted_ = weights_ / (1 + squared_residuals * (1 / (width * width)));
    SolvePoints();
    SolveCentres();
    SetAlong();
    SolvePoints();
  }

  // Computes |entry - centre * inverse distance|^2 over its variance for each view and point;
  // unknown entries give 0.
  void SquaredResiduals(Rows& residuals) const {
    const auto d = pair_.inverse_distances.transpose().array();
    for (Eigen::Index i = 0; i < weights_.rows(); ++i) {
      const double length = pair_.centres.segment<3>(3 * i).squaredNorm();
      residuals.row(i) =
          weights_.row(i) * (squares_.row(i) - d * (2 * along_.row(i) - length * d)).max(0);
    }
  }

 private:
  // Computes the components of the entries along the centres.
  void SetAlong() {
    for (Eigen::Index i = 0; i < weights_.rows(); ++i) {
      const Eigen::Vector3d c = pair_.centres.segment<3>(3 * i);
      along_.row(i) = c.x() * entries_.row(3 * i) + c.y() * entries_.row(3 * i + 1) +
                      c.z() * entries_.row(3 * i + 2);
    }
  }

  // Solves for the inverse distances with the centres held.
  void SolvePoints() {
    numerator_.setZero();
    denominator_.setZero();
    for (Eigen::Index i = 0; i < weights_.rows(); ++i) {
      numerator_ += reweighted_.row(i) * along_.row(i);
      denominator_ += pair_.centres.segment<3>(3 * i).squaredNorm() * reweighted_.row(i);
    }
    pair_.inverse_distances =
        (denominator_ > 0).select(numerator_ / denominator_, 0).matrix().transpose();
  }

  // Solves for the centres with the inverse distances held, then scales all of them together to
  // unit length.
  void SolveCentres() {
    const auto d = pair_.inverse_distances.transpose().array();
    for (Eigen::Index i = 0; i < weights_.rows(); ++i) {
      Row& weighted = numerator_;
      weighted = reweighted_.row(i) * d;
      const double denominator = (weighted * d).sum();
      pair_.centres.segment<3>(3 * i).setZero();
      if (!(denominator > 0)) continue;
      for (Eigen::Index j = 3 * i; j < 3 * i + 3; ++j) {
        pair_.centres(j) = (weighted * entries_.row(j)).sum() / denominator;
      }
    }
    const double length = pair_.centres.norm();
    if (length > 0) pair_.centres /= length;
  }

  Eigen::ArrayWrapper<const Rank1Rows> entries_;
  Eigen::ArrayWrapper<const Rank1Rows> weights_;
  Rows squares_;  // squared lengths of the entries
  Rows along_;
  Rows reweighted_;
  Row numerator_;
  Row denominator_;
  RankOne pair_;
};

// Chooses the sign, which an SVD leaves open, so that most points are in front of the camera.
void FixSign(RankOne& pair) {
  const auto negative = (pair.inverse_distances.array() < 0).count();
  const auto positive = (pair.inverse_distances.array() > 0).count();
  if (negative <= positive) return;
  pair.centres = -pair.centres;
  pair.inverse_distances = -pair.inverse_distances;
}

// Returns the centres of the unweighted solution. Each column is scaled by the root of its mean
// weight, which leaves the matrix rank one, so that rays near the epipole do not drown the others.
Eigen::VectorXd StartingCentres(const Rank1Matrix& matrix) {
  const Eigen::RowVectorXd worth = matrix.weights().colwise().mean().cwiseSqrt();
  return LeadingPair(matrix.entries() * worth.asDiagonal()).centres;
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

Rank1Matrix::RayRows Rank1Matrix::UnitRays(std::span<const Eigen::Vector2d> points) {
  const CoordinateRows rows(points);
  const Row inverse_length = 1 / (rows.x.square() + rows.y.square() + 1).sqrt();
  return {rows.x * inverse_length, rows.y * inverse_length, inverse_length};
}

Rank1Matrix::Rank1Matrix(std::span<const Eigen::Vector2d> reference_points,
                         std::span<const Rank1View> views,
                         double min_epipole_angle)
    : entries_(3 * views.size(), reference_points.size()),
      weights_(views.size(), reference_points.size()) {
  const RayRows p = UnitRays(reference_points);
  const double min_sine = math::Sin(min_epipole_angle);
  const double min_squared_sine = min_sine * min_sine;
  for (std::size_t i = 0; i < views.size(); ++i) {
    PLUMBLINE_CHECK(views[i].points.size() == reference_points.size() &&
                        views[i].sigmas.size() == reference_points.size(),
                    "one place and one sigma for each point");
    SetView(static_cast<Eigen::Index>(i), views[i], p, min_squared_sine);
  }
}

// Fills the rows of a view. q is not normalized: its squared length in eq. 3 takes the place of the
// division.
void Rank1Matrix::SetView(Eigen::Index i,
                          const Rank1View& view,
                          const RayRows& p,
                          double min_squared_sine) {
  const CoordinateRows seen(view.points);
  const Eigen::Matrix3d turn =
      UnitRotation(view.reference_from_cam, "the rotation of a view").toRotationMatrix();
  const auto turned = [&](Eigen::Index row) -> Row {
    return turn(row, 0) * seen.x + turn(row, 1) * seen.y + turn(row, 2);
  };
  const RayRows q{turned(0), turned(1), turned(2)};
  const Eigen::Vector3d& t = view.centre_direction;
  const Row squared_length = q.x.square() + q.y.square() + q.z.square();
  const Row tq = t.x() * q.x + t.y() * q.y + t.z() * q.z;
  const Row tp = t.x() * p.x + t.y() * p.y + t.z() * p.z;
  const Row qp = q.x * p.x + q.y * p.y + q.z * p.z;
  const Row across = squared_length - tq.square();  // the square of q's component across t
  const Eigen::Map<const Row> sigmas(view.sigmas.data(), tq.size());
  // Points without a position are left out, and rays along t, for which the two lines are parallel.
  const Row known = (sigmas > 0 && across > min_squared_sine * squared_length).cast<double>();
  const Row half = 0.5 * known / (known > 0).select(across, 1);
  const Row s0 = half * (squared_length * tp - tq * qp);
  const Row s = half * (qp - tq * tp);
  const Row half_known = 0.5 * known;
  entries_.row(3 * i) = s0 * t.x() + half_known * p.x - s * q.x;
  entries_.row(3 * i + 1) = s0 * t.y() + half_known * p.y - s * q.y;
  entries_.row(3 * i + 2) = s0 * t.z() + half_known * p.z - s * q.z;
  weights_.row(i) = known * across / (known > 0).select(squared_length * sigmas.square(), 1);
}

RankOne LeadingPair(const Rank1Rows& entries) {
  const Eigen::MatrixXd gram = entries * entries.transpose();
  // The column with the largest norm is not orthogonal to the vector that is sought.
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
  const Rank1Rows& weights = matrix.weights();
  const auto most = weights.colwise().maxCoeff().eval();
  if ((most.array() > 0).count() < 3) return std::nullopt;
  if (!(weights.rowwise().maxCoeff().minCoeff() > 0)) return std::nullopt;
  Alternation alternation(matrix, StartingCentres(matrix));
  SpreadOfKnown spread(weights);
  Rows residuals(weights.rows(), weights.cols());
  alternation.SquaredResiduals(residuals);
  for (int i = 0; i < options.iterations; ++i) {
    alternation.Step(residuals, options.loss_width * std::max(kMinSpread, spread(residuals)));
    alternation.SquaredResiduals(residuals);
  }
  RankOne& pair = alternation.pair();
  FixSign(pair);
  for (Eigen::Index k = 0; k < weights.cols(); ++k) {
    if (!(most(k) > 0)) pair.inverse_distances(k) = 0;
  }
  return ToSolution(pair, spread(residuals));
}

}  // namespace plumbline
