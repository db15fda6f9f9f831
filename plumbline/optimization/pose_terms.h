// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"
#include "plumbline/optimization/problem.h"
#include "plumbline/optimization/residuals.h"
#include "plumbline/optimization/robust_loss.h"

#include <optional>
#include <utility>

namespace plumbline {

// Matches with fixed landmarks, prepared for the solver, and their part of the normal equations of
// the pose. Internal to pose_solver.h.

struct PosePoint {
  Eigen::Vector3d in_world;
  PointTerm term;
  std::optional<Eigen::Matrix3d> whitening;  // for the residuals of an UncertainPointTerm
};

// A match of a line, with the functions that PoseSolver needs.
class PoseLine {
 public:
  // The linearized residual in the camera of the measurement.
  struct Linearization {
    LineLinearization at;
    Eigen::Vector3d direction, moment;
  };

  PoseLine(const RectifiedCamera& camera, const PoseProblem::LineMatch& match)
      : moment_(match.line_in_world.moment),
        direction_(match.line_in_world.direction),
        term_(MakeLineTerm(camera, match.measurement)) {}

  // Linearizes at a pose with rotation R; returns false if the residual is not defined.
  bool Linearize(const RectifiedCamera& camera,
                 const Rigid3& pose,
                 const Eigen::Matrix3d& R,
                 Linearization& out) const {
    out.direction = R * direction_;
    out.moment = MomentInCamera(R, pose.translation, out.direction);
    return LinearizeLine(camera, term_, out.moment, out.at);
  }
  // Returns the derivatives of the two residuals with respect to the left perturbation of the pose.
  std::pair<Vector6d, Vector6d> PoseRows(const Linearization& lin) const {
    return {LinePoseRow(lin.at.h0, lin.moment, lin.direction, term_.shift),
            LinePoseRow(lin.at.h1, lin.moment, lin.direction, term_.shift)};
  }
  // Computes only the residuals, at the pose with rotation R and translation t; returns false if
  // they are not defined.
  bool Distances(const RectifiedCamera& camera,
                 const Eigen::Matrix3d& R,
                 const Eigen::Vector3d& t,
                 Eigen::Vector2d& r) const {
    return WhitenedLineDistances(camera, term_, MomentInCamera(R, t, R * direction_), r);
  }

 private:
  Eigen::Vector3d MomentInCamera(const Eigen::Matrix3d& R,
                                 const Eigen::Vector3d& t,
                                 const Eigen::Vector3d& direction) const {
    return R * moment_ + Eigen::Vector3d(t.x() + term_.shift, t.y(), t.z()).cross(direction);
  }

  Eigen::Vector3d moment_, direction_;  // in the world
  LineTerm term_;
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
