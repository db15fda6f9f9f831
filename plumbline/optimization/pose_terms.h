// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"
#include "plumbline/optimization/problem.h"
#include "plumbline/optimization/residuals.h"

#include <optional>

namespace plumbline {

// Matches with fixed landmarks, prepared for the solver, and their part of the normal equations of
// the pose. Internal to pose_solver.h.

struct PosePoint {
  Eigen::Vector3d in_world;
  PointTerm term;
  std::optional<Eigen::Matrix3d> whitening;  // for the residuals of an UncertainPointTerm
};

// Normal equations at one pose. Only the lower triangle of H is set.
struct PoseSums {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  double cost = 0;
};

// Adds w J^T J and w J^T r of a point whose rows are J = G [-[p]x, I]. With M = w G^T G the blocks
// are [p]x M [p]x^T, [p]x M and M.
inline void AddPoint(const PointLinearization& a,
                     const Eigen::Vector3d& p,
                     double w,
                     PoseSums& eq) {
  const double wux = w * a.ux;
  const double wvy = w * a.vy;
  const double m00 = wux * a.ux;
  const double m02 = wux * a.uz;
  const double m11 = wvy * a.vy;
  const double m12 = wvy * a.vz;
  const double m22 = w * (a.uz * a.uz + a.vz * a.vz + a.dz * a.dz);
  const Eigen::Vector3d q(
      wux * a.r.x(), wvy * a.r.y(), w * (a.uz * a.r.x() + a.vz * a.r.y() + a.dz * a.r.z()));
  const Eigen::Vector3d c0(m00, 0, m02);
  const Eigen::Vector3d c1(0, m11, m12);
  const Eigen::Vector3d c2(m02, m12, m22);
  Eigen::Matrix3d PM;
  PM << p.cross(c0), p.cross(c1), p.cross(c2);
  for (int i = 0; i < 3; ++i) {
    eq.H.block<3, 1>(0, i) += p.cross(PM.row(i).transpose());
    eq.H.block<3, 1>(3, i) += PM.row(i).transpose();
  }
  eq.H(3, 3) += m00;
  eq.H(4, 4) += m11;
  eq.H(5, 3) += m02;
  eq.H(5, 4) += m12;
  eq.H(5, 5) += m22;
  eq.g.head<3>() += p.cross(q);
  eq.g.tail<3>() += q;
}

// Adds a point with a general G, without known zeros.
inline void AddPoint(const Eigen::Vector3d& r,
                     const Eigen::Matrix3d& G,
                     const Eigen::Vector3d& p,
                     double w,
                     PoseSums& eq) {
  Eigen::Matrix<double, 3, 6> J;
  J << -G * Skew(p), G;
  const Eigen::Matrix<double, 3, 6> wJ = w * J;
  eq.H.noalias() += wJ.transpose() * J;
  eq.g.noalias() += wJ.transpose() * r;
}

// Adds a line to the cost and, with w J^T J and w J^T r of the two rows, to the equations.
inline void AddLine(
    const Eigen::Vector2d& r, double huber, const Vector6d& a, const Vector6d& b, PoseSums& eq) {
  const double chi2 = r.squaredNorm();
  const double w = HuberWeight(chi2, huber);
  eq.cost += 0.5 * HuberLoss(chi2, huber);
  const Vector6d wa = w * a;
  const Vector6d wb = w * b;
  eq.H.noalias() += wa * a.transpose() + wb * b.transpose();
  eq.g += r(0) * wa + r(1) * wb;
}

}  // namespace plumbline
