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
};

// Of the same match, for residuals of projected ends.
struct PoseLineEnds {
  Segment3 ends;  // in the world
  ProjectedEndsTerm term;
};

// A line in the camera that measured it.
struct PoseLineInCamera {
  Eigen::Vector3d direction, moment;

  PoseLineInCamera(const PoseLine& line, const Eigen::Matrix3d& R, const Eigen::Vector3d& t)
      : direction(R * line.direction),
        moment(R * line.moment +
               Eigen::Vector3d(t.x() + line.term.shift, t.y(), t.z()).cross(direction)) {}
};

// Normal equations at one pose. Of H only the lower triangle is set.
struct PoseSums {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  double cost = 0;
};

}  // namespace plumbline
