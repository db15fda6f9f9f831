// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/translation.h"

#include "plumbline/geometry/epipolar.h"
#include "plumbline/solvers/epipolar_cost.h"

#include <cmath>

#include <Eigen/Dense>

namespace plumbline {
namespace {

Eigen::Vector3d PlaneNormal(const Eigen::Quaterniond& b_from_a, const RayMatch& match) {
  return (b_from_a * match.a.homogeneous()).cross(match.b.homogeneous());
}

// Standard deviation of t . (R x_a x x_b): the root of what SampsonChi2 divides by.
double Deviation(const Eigen::Matrix3d& essential, const RayMatch& match) {
  const Eigen::Vector3d in_b = essential * match.a.homogeneous();
  const Eigen::Vector3d in_a = essential.transpose() * match.b.homogeneous();
  return std::sqrt(match.sigma_b * match.sigma_b * in_b.head<2>().squaredNorm() +
                   match.sigma_a * match.sigma_a * in_a.head<2>().squaredNorm());
}

}  // namespace

std::optional<Eigen::Vector3d> TranslationFromTwoPoints(const Eigen::Quaterniond& b_from_a,
                                                        std::span<const RayMatch, 2> matches) {
  const Eigen::Vector3d first = PlaneNormal(b_from_a, matches[0]);
  const Eigen::Vector3d second = PlaneNormal(b_from_a, matches[1]);
  const Eigen::Vector3d t = first.cross(second);
  if (!(t.norm() > 1e-9 * first.norm() * second.norm())) return std::nullopt;
  return t.normalized();
}

std::optional<Eigen::Vector3d> TranslationFromPoints(const Eigen::Quaterniond& b_from_a,
                                                     std::span<const RayMatch> matches,
                                                     const Eigen::Vector3d& start) {
  const Eigen::Matrix3d essential = EssentialMatrix({b_from_a, start});
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  for (const RayMatch& match : matches) {
    const double deviation = Deviation(essential, match);
    if (!(deviation > 0)) continue;
    const Eigen::Vector3d row = PlaneNormal(b_from_a, match) / deviation;
    normal += row * row.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(normal);
  if (!(solver.eigenvalues()(1) > 1e-12 * solver.eigenvalues()(2))) return std::nullopt;
  const Eigen::Vector3d t = solver.eigenvectors().col(0);
  return t.dot(start) < 0 ? Eigen::Vector3d(-t) : t;
}

}  // namespace plumbline
