// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/pose_optimization.h"

#include "plumbline/geometry/se3.h"
#include "plumbline/optimization/pose_solver.h"

#include <utility>

namespace plumbline {
namespace {

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

}  // namespace

PoseOnlyResult SolvePose(const PoseProblem& problem, const PoseOnlyOptions& options) {
  const Rigid3& given = problem.cam_from_world;
  const Rigid3 initial{UnitRotation(given.rotation, "cam_from_world"), given.translation};
  return PoseSolver<PoseLine>(problem, options).Solve(initial);
}

}  // namespace plumbline
