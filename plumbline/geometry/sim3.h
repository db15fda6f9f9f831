// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// A tangent of Sim(3), [rotation(3), translation(3), log scale].
using Vector7d = Eigen::Matrix<double, 7, 1>;
// A covariance, information or Jacobian of tangents of Sim(3).
using Matrix7d = Eigen::Matrix<double, 7, 7>;

// A similarity b_from_a: p_b = scale * rotation * p_a + translation. Perturbations are from the
// left, tangent = [rotation(3), translation(3), log scale].
struct Similarity3 {
  double scale = 1;
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  // Returns a point of frame a in frame b.
  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return scale * (rotation * point) + translation;
  }
  // Returns b_from_x, the product of b_from_a and a_from_x.
  Similarity3 operator*(const Similarity3& a_from_x) const {
    return {scale * a_from_x.scale,
            (rotation * a_from_x.rotation).normalized(),
            scale * (rotation * a_from_x.translation) + translation};
  }
  // Returns the similarity as a matrix of homogeneous coordinates.
  Eigen::Matrix4d Matrix() const;
};

// Returns the rigid motion as a similarity of scale 1.
inline Similarity3 ToSimilarity(const Rigid3& motion) {
  return {1.0, motion.rotation, motion.translation};
}

// Returns a_from_b for b_from_a.
Similarity3 Inverse(const Similarity3& b_from_a);

// Returns the pose of a camera after a transformation of its world: world_b_from_cam without the
// scale (the camera's own axes keep their length).
Rigid3 TransformPose(const Similarity3& b_from_a, const Rigid3& a_from_cam);

// Exponential map of sim(3).
Similarity3 ExpSim3(const Vector7d& tangent);
// Inverse of ExpSim3, with a rotation part of at most pi.
Vector7d LogSim3(const Similarity3& similarity);

// Returns exp(tangent) * similarity, the update of similarities in optimization.
inline Similarity3 RetractLeft(const Similarity3& similarity, const Vector7d& tangent) {
  return ExpSim3(tangent) * similarity;
}

// Adjoint: S exp(x) S^-1 = exp(Adjoint(S) x).
Matrix7d Adjoint(const Similarity3& similarity);

// Left Jacobian: Exp(x + dx) = Exp(LeftJacobianSim3(x) dx) Exp(x) to first order. Computed by the
// power series in ad(x) (with the scaling and doubling of matrix functions for large x), to about
// 1e-13.
Matrix7d LeftJacobianSim3(const Vector7d& tangent);
// The inverse of LeftJacobianSim3(x), which is the derivative of Log(exp(dx) S) at x = Log(S).
Matrix7d InverseLeftJacobianSim3(const Vector7d& tangent);

}  // namespace plumbline
