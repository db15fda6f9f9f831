// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/alignment_sample.h"

#include "plumbline/geometry/basis_across.h"
#include "plumbline/geometry/rotation_fit.h"

#include <cstddef>

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

// Sums target * source^T over normalized pairs of vectors.
class TurnedVectors {
 public:
  void Add(const Eigen::Vector3d& source, const Eigen::Vector3d& target) {
    const double lengths = source.norm() * target.norm();
    if (lengths > 0) sum_ += target * source.transpose() / lengths;
  }

  // Returns nullopt if the vectors are collinear.
  std::optional<Eigen::Quaterniond> Rotation() const {
    constexpr double kLeast = 1e-3;
    const RotationFit fit = FitRotation(sum_);
    if (!(fit.singular_values(1) > kLeast * fit.singular_values(0))) return std::nullopt;
    return Eigen::Quaterniond(fit.rotation).normalized();
  }

 private:
  Eigen::Matrix3d sum_ = Eigen::Matrix3d::Zero();
};

// Returns the vector from the line to the point, perpendicular to the line.
Eigen::Vector3d Perpendicular(const PluckerLine& line, const Eigen::Vector3d& point) {
  return point - line.PointAt(line.ParameterOf(point));
}

Eigen::Vector3d Middle(const LineModel& line) {
  return line.line.PointAt(0.5 * (line.start + line.end));
}

// The rows of the linear equations for [translation, scale].
class LinearEquations {
 public:
  template <int kRows>
  void Add(const Eigen::Matrix<double, kRows, 3>& across,
           const Eigen::Vector3d& turned_source,
           const Eigen::Vector3d& target,
           double weight) {
    Eigen::Matrix<double, kRows, 4> A;
    A << across, across * turned_source;
    H_ += weight * A.transpose() * A;
    g_ += weight * A.transpose() * (across * target);
  }

  std::optional<Eigen::Vector4d> Solve(bool free_scale) const {
    constexpr double kLeast = 1e-9;
    const int size = free_scale ? 4 : 3;
    Eigen::VectorXd g = g_.head(size);
    if (!free_scale) g -= H_.topRightCorner<3, 1>();
    const Eigen::LDLT<Eigen::MatrixXd> factor(H_.topLeftCorner(size, size));
    const Eigen::VectorXd D = factor.vectorD();
    if (!(D.minCoeff() > kLeast * D.maxCoeff())) return std::nullopt;
    Eigen::Vector4d solution(0, 0, 0, 1);
    solution.head(size) = factor.solve(g);
    return solution;
  }

 private:
  Eigen::Matrix4d H_ = Eigen::Matrix4d::Zero();
  Eigen::Vector4d g_ = Eigen::Vector4d::Zero();
};

}  // namespace

std::optional<Similarity3> AlignSample(std::span<const AlignmentProblem::PointPair> points,
                                       std::span<const AlignmentProblem::LinePair> lines,
                                       bool free_scale) {
  TurnedVectors vectors;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      vectors.Add(points[i].in_query.place - points[j].in_query.place,
                  points[i].in_candidate.place - points[j].in_candidate.place);
    }
    for (const auto& line : lines) {
      vectors.Add(Perpendicular(line.in_query.line, points[i].in_query.place),
                  Perpendicular(line.in_candidate.line, points[i].in_candidate.place));
    }
  }
  for (const auto& line : lines) {
    vectors.Add(line.in_query.line.direction, line.in_candidate.line.direction);
  }
  const auto rotation = vectors.Rotation();
  if (!rotation) return std::nullopt;
  LinearEquations equations;
  // Weights fall with the depth, because errors of depth grow with it.
  const auto weight = [](const Eigen::Vector3d& target) { return 1 / target.squaredNorm(); };
  for (const auto& pair : points) {
    equations.Add<3>(Eigen::Matrix3d::Identity(),
                     *rotation * pair.in_query.place,
                     pair.in_candidate.place,
                     weight(pair.in_candidate.place));
  }
  for (const auto& pair : lines) {
    equations.Add<2>(BasisAcross(pair.in_candidate.line.direction).transpose(),
                     *rotation * Middle(pair.in_query),
                     Middle(pair.in_candidate),
                     weight(Middle(pair.in_candidate)));
  }
  const auto solution = equations.Solve(free_scale);
  if (!solution || !((*solution)(3) > 0) || !solution->allFinite()) return std::nullopt;
  return Similarity3{(*solution)(3), *rotation, solution->head<3>()};
}

}  // namespace plumbline
