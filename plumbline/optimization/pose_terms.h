// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"
#include "plumbline/optimization/projected_ends.h"
#include "plumbline/optimization/residuals.h"

#include <cstddef>

namespace plumbline {

// Matches with landmarks that stay fixed, ready for use, and their part of the normal equations of
// the pose. Internal to pose_only.cc.

struct PosePoint {
  Eigen::Vector3d in_world;
  PointTerm term;
};

struct PoseLine {
  Eigen::Vector3d moment, direction;  // in the world
  LineTerm term;
  std::size_t group = 0;  // dense index
  // With residuals of projected ends:
  Segment3 ends;  // in the world
  ProjectedEndsTerm ends_term;
};

// Whitened residual of a line and its derivatives by the pose.
struct PoseLineRows {
  Eigen::Vector2d r;
  Vector6d a, b;
};

// The line's moment in the frame of the camera that measured it.
inline Eigen::Vector3d MomentInCamera(const PoseLine& line,
                                      const Eigen::Matrix3d& R,
                                      Eigen::Vector3d t) {
  t.x() += line.term.shift;
  return R * line.moment + t.cross(R * line.direction);
}

inline bool ObservedEndsRows(const RectifiedCamera& camera,
                             const PoseLine& line,
                             const Eigen::Matrix3d& R,
                             const Eigen::Vector3d& t,
                             PoseLineRows& out) {
  const Eigen::Vector3d direction = R * line.direction;
  const Eigen::Vector3d moment = MomentInCamera(line, R, t);
  LineLinearization lin;
  if (!LinearizeLine(camera, line.term, moment, lin)) return false;
  out.r = lin.r;
  out.a = LinePoseRow(lin.h0, moment, direction, line.term.shift);
  out.b = LinePoseRow(lin.h1, moment, direction, line.term.shift);
  return true;
}

inline bool ProjectedEndsRows(const PoseLine& line,
                              const Eigen::Matrix3d& R,
                              const Eigen::Vector3d& t,
                              PoseLineRows& out) {
  const Segment3 ends{R * line.ends.start + t, R * line.ends.end + t};
  ProjectedEndsLinearization lin;
  if (!LinearizeProjectedEnds(line.ends_term, ends, lin)) return false;
  const auto [a, b] = PoseRows(lin, ends);
  out = {lin.r, a, b};
  return true;
}

// Normal equations at one pose. Of H only the lower triangle is set.
struct PoseSums {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  double cost = 0;
};

// Adds w J^T J and w J^T r of a point whose rows are J = G [-[p]x, I], so that with M = w G^T G the
// blocks are [p]x M [p]x^T, [p]x M and M.
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

}  // namespace plumbline
