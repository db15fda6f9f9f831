// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/sim3.h"

#include "plumbline/base/elementary.h"

#include <cmath>

#include <Eigen/LU>

namespace plumbline {
namespace {

// Returns W = int_0^1 exp(u log_scale) Exp(u w) du, the matrix that turns the translation tangent
// into the translation. With A = log_scale I + [w]x it is the series sum A^k / (k + 1)!. A quarter
// of A (or less) converges fast, and W(2A) = (exp(A) + I) W(A) / 2.
Eigen::Matrix3d TranslationFactor(const Eigen::Vector3d& w, double log_scale) {
  constexpr double kSmall = 0.5;
  constexpr int kTerms = 16;
  const double size = w.norm() + std::abs(log_scale);
  int halvings = 0;
  double shrink = 1;
  while (shrink * size > kSmall) {
    shrink *= 0.5;
    ++halvings;
  }
  const Eigen::Matrix3d A = shrink * (log_scale * Eigen::Matrix3d::Identity() + Skew(w));
  Eigen::Matrix3d factor = Eigen::Matrix3d::Identity();
  for (int k = kTerms; k >= 1; --k) factor = Eigen::Matrix3d::Identity() + A * factor / (k + 1);
  for (int i = 0; i < halvings; ++i) {
    const Eigen::Matrix3d exponential =
        math::Exp(shrink * log_scale) * ExpSo3(shrink * w).toRotationMatrix();
    factor = 0.5 * (exponential + Eigen::Matrix3d::Identity()) * factor;
    shrink *= 2;
  }
  return factor;
}

// Returns ad(x) of sim(3): ad(x) y = [x, y].
Matrix7d SmallAdjoint(const Vector7d& tangent) {
  const Eigen::Matrix3d W = Skew(tangent.head<3>());
  const Eigen::Vector3d v = tangent.segment<3>(3);
  Matrix7d ad = Matrix7d::Zero();
  ad.block<3, 3>(0, 0) = W;
  ad.block<3, 3>(3, 0) = Skew(v);
  ad.block<3, 3>(3, 3) = W + tangent(6) * Eigen::Matrix3d::Identity();
  ad.block<3, 1>(3, 6) = -v;
  return ad;
}

}  // namespace

Eigen::Matrix4d Similarity3::Matrix() const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = scale * rotation.toRotationMatrix();
  m.topRightCorner<3, 1>() = translation;
  return m;
}

Similarity3 Inverse(const Similarity3& b_from_a) {
  const Eigen::Quaterniond rotation = b_from_a.rotation.conjugate();
  const double scale = 1 / b_from_a.scale;
  return {scale, rotation, -scale * (rotation * b_from_a.translation)};
}

Rigid3 TransformPose(const Similarity3& b_from_a, const Rigid3& a_from_cam) {
  return {(b_from_a.rotation * a_from_cam.rotation).normalized(),
          b_from_a * a_from_cam.translation};
}

Similarity3 ExpSim3(const Vector7d& tangent) {
  const Eigen::Vector3d w = tangent.head<3>();
  return {
      math::Exp(tangent(6)), ExpSo3(w), TranslationFactor(w, tangent(6)) * tangent.segment<3>(3)};
}

Vector7d LogSim3(const Similarity3& similarity) {
  const Eigen::Vector3d w = LogSo3(similarity.rotation);
  const double log_scale = math::Log(similarity.scale);
  Vector7d tangent;
  tangent << w, TranslationFactor(w, log_scale).partialPivLu().solve(similarity.translation),
      log_scale;
  return tangent;
}

Matrix7d Adjoint(const Similarity3& similarity) {
  const Eigen::Matrix3d R = similarity.rotation.toRotationMatrix();
  Matrix7d adjoint = Matrix7d::Identity();
  adjoint.block<3, 3>(0, 0) = R;
  adjoint.block<3, 3>(3, 0) = Skew(similarity.translation) * R;
  adjoint.block<3, 3>(3, 3) = similarity.scale * R;
  adjoint.block<3, 1>(3, 6) = -similarity.translation;
  return adjoint;
}

Matrix7d LeftJacobianSim3(const Vector7d& tangent) {
  constexpr double kSmall = 0.5;
  constexpr int kTerms = 18;
  int halvings = 0;
  Vector7d x = tangent;
  while (SmallAdjoint(x).lpNorm<Eigen::Infinity>() > kSmall) {
    x *= 0.5;
    ++halvings;
  }
  const Matrix7d ad = SmallAdjoint(x);
  Matrix7d J = Matrix7d::Identity();
  for (int k = kTerms; k >= 1; --k) J = Matrix7d::Identity() + ad * J / (k + 1);
  // J(2x) = (Ad(Exp(x)) + I) J(x) / 2.
  for (int i = 0; i < halvings; ++i) {
    J = 0.5 * (Adjoint(ExpSim3(x)) + Matrix7d::Identity()) * J;
    x *= 2;
  }
  return J;
}

Matrix7d InverseLeftJacobianSim3(const Vector7d& tangent) {
  return LeftJacobianSim3(tangent).partialPivLu().inverse();
}

}  // namespace plumbline
