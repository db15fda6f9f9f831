// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/optimization/problem.h"
#include "plumbline/optimization/residuals.h"
#include "plumbline/optimization/robust_loss.h"
#include "plumbline/optimization/schur_solver.h"

#include <limits>

namespace plumbline {

// What bundle adjustment needs to know about each kind of landmark: parameters, residual, its place
// in the normal equations. Internal to local_ba.cc; declared here to be tested and benchmarked.

struct BaPose {
  Rigid3 cam_from_world;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  int free_index = -1;  // -1: fixed

  void Set(const Rigid3& value) {
    cam_from_world = value;
    R = value.rotation.toRotationMatrix();
  }
};

struct BaPoint {
  static constexpr int kDof = 3;
  using State = Eigen::Vector3d;
  using Term = PointTerm;
  using View = Eigen::Vector3d;  // of a state, computed once for all its observations

  static View MakeView(const State& state) { return state; }
  static State Retract(const State& state, const Eigen::Vector3d& step) { return state + step; }
  static double Huber(const Term& term, const HuberThresholds& huber) {
    return term.disparity_weight > 0 ? huber.disparity : huber.point;
  }
  static int Dof(const Term& term) { return term.disparity_weight > 0 ? 3 : 2; }

  // Squared norm of the whitened residual; infinite where there is none.
  static double Chi2(const RectifiedCamera& camera,
                     const BaPose& pose,
                     const View& view,
                     const Term& term) {
    const Eigen::Vector3d p = pose.R * view + pose.cam_from_world.translation;
    return PointChi2(camera, term, p).value_or(std::numeric_limits<double>::infinity());
  }

  // Where an observation adds its part of the normal equations. `pose` and `W` are null for a
  // fixed pose.
  struct Target {
    LandmarkEquations<kDof>& landmark;
    PoseEquations* pose;
    Eigen::Matrix<double, 6, kDof>* W;
  };
  // False when the observation has no residual; nothing is added then.
  static bool Add(const RectifiedCamera& camera,
                  const BaPose& pose,
                  const View& view,
                  const Term& term,
                  double huber,
                  const Target& target);
};

struct BaLine {
  static constexpr int kDof = 4;
  using State = OrthonormalLine;
  using Term = LineTerm;
  struct View {
    Eigen::Vector3d moment, direction;
    Eigen::Matrix<double, 6, 4> J;  // of both with respect to the orthonormal update
  };

  static View MakeView(const State& state) {
    const Vector6d h = state.Homogeneous();
    return {h.head<3>(), h.tail<3>(), HomogeneousJacobian(state)};
  }
  static State Retract(const State& state, const Eigen::Vector4d& step) {
    return plumbline::Retract(state, step);
  }
  static double Huber(const Term&, const HuberThresholds& huber) { return huber.line; }
  static int Dof(const Term&) { return 2; }

  static double Chi2(const RectifiedCamera& camera,
                     const BaPose& pose,
                     const View& view,
                     const Term& term);

  struct Target {
    LandmarkEquations<kDof>& landmark;
    PoseEquations* pose;
    Eigen::Matrix<double, 6, kDof>* W;
  };
  static bool Add(const RectifiedCamera& camera,
                  const BaPose& pose,
                  const View& view,
                  const Term& term,
                  double huber,
                  const Target& target);
};

}  // namespace plumbline
