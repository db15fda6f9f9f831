// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/parallel_lines.h"

#include "plumbline/base/chi2.h"
#include "plumbline/base/elementary.h"
#include "plumbline/geometry/basis_across.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

namespace plumbline {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr double kSigma = 0.2 * kRadians;
constexpr double kWellKnown = 1 * kRadians;
constexpr double kNear = 2 * kRadians;
constexpr std::size_t kMinLines = 5;
constexpr std::size_t kMinViews = 3;
constexpr double kMaxChance = 0.005;
// Further away the angle is not small, and chi2 of its sine says nothing.
constexpr double kMinCosine = 0.9;

using Basis = Eigen::Matrix<double, 3, 2>;

// How far a line's direction is from another one, in a basis across the latter.
struct Deviation {
  Eigen::Vector2d angle = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  bool agrees = false;
};

// sigma: of the difference beyond the line's covariance.
Deviation DeviationFrom(const Eigen::Vector3d& axis,
                        const Basis& across,
                        const LineDirection& line,
                        double sigma) {
  Deviation out;
  const double cosine = axis.dot(line.direction);
  out.angle = (cosine < 0 ? -1 : 1) * (across.transpose() * line.direction);
  out.covariance = across.transpose() * line.covariance * across;
  out.covariance.diagonal().array() += sigma * sigma;
  const double chi2 = out.angle.dot(out.covariance.inverse() * out.angle);
  out.agrees = std::abs(cosine) >= kMinCosine && chi2 <= Chi2Limit95(2);
  return out;
}

using Lines = std::vector<const LineDirection*>;

// The line with most others near it; nullptr when there are not enough anywhere.
const LineDirection* Seed(const Lines& lines) {
  const double near = math::Cos(kNear);
  std::ptrdiff_t most = kMinLines - 1;
  const LineDirection* seed = nullptr;
  for (const LineDirection* candidate : lines) {
    const auto votes = std::count_if(lines.begin(), lines.end(), [&](const LineDirection* line) {
      return std::abs(line->direction.dot(candidate->direction)) >= near;
    });
    if (votes <= most) continue;
    most = votes;
    seed = candidate;
  }
  return seed;
}

// Gauss-Newton on the deviations of the lines that agree, chosen anew in each step. Those that do
// not agree in the last one are left in `others`.
CommonDirection WeightedMean(const Eigen::Vector3d& start, const Lines& lines, Lines& others) {
  constexpr int kSteps = 4;
  CommonDirection mean{start, 0};
  for (int step = 0; step < kSteps; ++step) {
    const Basis across = BasisAcross(mean.direction);
    others.clear();
    Eigen::Matrix2d H = Eigen::Matrix2d::Zero();
    Eigen::Vector2d g = Eigen::Vector2d::Zero();
    for (const LineDirection* line : lines) {
      const Deviation d = DeviationFrom(mean.direction, across, *line, kSigma);
      if (!d.agrees) {
        others.push_back(line);
        continue;
      }
      const Eigen::Matrix2d weight = d.covariance.inverse();
      H += weight;
      g += weight * d.angle;
    }
    if (others.size() == lines.size()) break;
    const Eigen::Matrix2d covariance = H.inverse();
    mean.direction = (mean.direction + across * covariance * g).normalized();
    mean.sigma = std::sqrt(covariance.trace());
  }
  return mean;
}

}  // namespace

double ParallelSigma() { return kSigma; }

std::optional<LineDirection> DirectionOf(const PluckerLine& line,
                                         const Eigen::Matrix4d& information) {
  const Eigen::LLT<Eigen::Matrix4d> factor(information);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Eigen::Matrix3d U = ToOrthonormal(line).U.toRotationMatrix();
  Eigen::Matrix<double, 3, 4> J = Eigen::Matrix<double, 3, 4>::Zero();
  J.col(0) = U.col(2);
  J.col(2) = -U.col(0);
  const Eigen::Matrix3d covariance = J * factor.solve(J.transpose());
  if (!covariance.allFinite()) return std::nullopt;
  return LineDirection{line.direction, covariance};
}

std::vector<CommonDirection> CommonDirections(const std::vector<LineDirection>& lines) {
  Lines left;
  for (const LineDirection& line : lines) {
    if (line.covariance.trace() <= kWellKnown * kWellKnown) left.push_back(&line);
  }
  std::vector<CommonDirection> out;
  while (const LineDirection* seed = Seed(left)) {
    Lines others;
    const CommonDirection mean = WeightedMean(seed->direction, left, others);
    if (left.size() - others.size() >= kMinLines) {
      out.push_back(mean);
      left = std::move(others);
    } else {
      left.erase(std::find(left.begin(), left.end(), seed));
    }
  }
  return out;
}

std::vector<CommonDirection> CommonDirections(const Map& map) {
  std::vector<LineDirection> lines;
  for (const auto& [id, line] : map.lines()) {
    if (line.observations.size() < kMinViews) continue;
    if (const auto direction = DirectionOf(line.line, line.information)) {
      lines.push_back(*direction);
    }
  }
  return CommonDirections(lines);
}

std::optional<std::size_t> ParallelTo(const LineDirection& line,
                                      const std::vector<CommonDirection>& directions) {
  std::optional<std::size_t> out;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const Eigen::Vector3d& axis = directions[i].direction;
    const Deviation d =
        DeviationFrom(axis, BasisAcross(axis), line, math::Hypot(kSigma, directions[i].sigma));
    if (!d.agrees) continue;
    // The ellipse that passes, as a share of the hemisphere of all directions.
    const double chance = 0.5 * Chi2Limit95(2) * std::sqrt(d.covariance.determinant());
    if (out || chance > kMaxChance) return std::nullopt;
    out = i;
  }
  return out;
}

}  // namespace plumbline
