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
  // What is computed once for a state and serves all its observations: what residuals need, and
  // what their derivatives need as well.
  using Place = Eigen::Vector3d;
  using View = Eigen::Vector3d;

  static Place MakePlace(const State& state) { return state; }
  static View MakeView(const State& state) { return state; }
  static State Retract(const State& state, const Eigen::Vector3d& step) { return state + step; }
  static double Huber(const Term& term, const HuberThresholds& huber) {
    return term.disparity_weight > 0 ? huber.disparity : huber.point;
  }
  static int Dof(const Term& term) { return term.disparity_weight > 0 ? 3 : 2; }
  // Completes the equations of a landmark whose parameters its observations cannot all fix.
  static void HoldGauge(const View&, LandmarkEquations<kDof>&) {}

  // Squared norm of the whitened residual; infinite where there is none.
  static double Chi2(const RectifiedCamera& camera,
                     const BaPose& pose,
                     const Place& place,
                     const Term& term) {
    const Eigen::Vector3d p = pose.R * place + pose.cam_from_world.translation;
    return PointChi2(camera, term, p).value_or(std::numeric_limits<double>::infinity());
  }

  using Target = BaTarget<kDof>;
  // False when the observation has no residual; nothing is added then.
  static bool Add(const RectifiedCamera& camera,
                  const BaPose& pose,
                  const View& view,
                  const Term& term,
                  double huber,
                  const Target& target);
};

// A line in the world. Of any scale: residuals depend on moment : direction alone.
struct BaLinePlace {
  Eigen::Vector3d moment, direction;
};

// What lines have in common, whatever their parameters.
template <int kParameters>
struct BaLineTerms {
  static constexpr int kDof = kParameters;
  using Term = LineTerm;
  using Place = BaLinePlace;
  struct View : BaLinePlace {
    Eigen::Matrix<double, 6, kDof> J;  // of moment and direction with respect to the update
  };

  static Term MakeTerm(const RectifiedCamera& camera, const LineMeasurement& measurement) {
    return MakeLineTerm(camera, measurement);
  }
  static double Huber(const Term&, const HuberThresholds& huber) { return huber.line; }
  static int Dof(const Term&) { return 2; }

  static double Chi2(const RectifiedCamera& camera,
                     const BaPose& pose,
                     const Place& place,
                     const Term& term);

  using Target = BaTarget<kDof>;
  static bool Add(const RectifiedCamera& camera,
                  const BaPose& pose,
                  const View& view,
                  const Term& term,
                  double huber,
                  const Target& target);
};
extern template struct BaLineTerms<4>;
extern template struct BaLineTerms<6>;

struct BaLine : BaLineTerms<4> {
  using State = OrthonormalLine;

  static Place MakePlace(const State& state) {
    const Vector6d h = state.Homogeneous();
    return {h.head<3>(), h.tail<3>()};
  }
  static View MakeView(const State& state) {
    return {MakePlace(state), HomogeneousJacobian(state)};
  }
  static State Retract(const State& state, const Eigen::Vector4d& step) {
    return RetractStraight(state, step);
  }
  static void HoldGauge(const View&, LandmarkEquations<kDof>&) {}
};

// A line by four parameters that turn it about the axes of the frame (PPL-SLAM). Undamped steps are
// those of BaLine to first order; the damping looks at other diagonal entries, and the step is
// taken along the arc.
struct BaLineLeft : BaLineTerms<4> {
  using State = OrthonormalLine;

  static Place MakePlace(const State& state) { return BaLine::MakePlace(state); }
  static View MakeView(const State& state) {
    return {MakePlace(state), LeftHomogeneousJacobian(state)};
  }
  static State Retract(const State& state, const Eigen::Vector4d& step) {
    return RetractLeft(state, step);
  }
  static void HoldGauge(const View&, LandmarkEquations<kDof>&) {}
};

// A line as two of its points, each with its three coordinates in the world.
struct BaLineEnds : BaLineTerms<6> {
  using State = Segment3;

  static Place MakePlace(const State& state) {
    return {state.start.cross(state.end), state.end - state.start};
  }
  static View MakeView(const State& state) {
    View view{MakePlace(state), {}};
    view.J << -Skew(state.end), Skew(state.start), -Eigen::Matrix3d::Identity(),
        Eigen::Matrix3d::Identity();
    return view;
  }
  static State Retract(const State& state, const Vector6d& step) {
    return {state.start + step.head<3>(), state.end + step.tail<3>()};
  }
  // No residual notices an end that slides along the line. Information of the size that the end has
  // across the line is added along it: a slide then is no longer free, and the rest of the step is
  // what it was, since the equations ask for no slide (their g has no part along it).
  static void HoldGauge(const View& view, LandmarkEquations<kDof>& equations) {
    HoldAlong(view.direction, equations);
  }
  static void HoldAlong(const Eigen::Vector3d& direction, LandmarkEquations<kDof>& equations) {
    const Eigen::Matrix3d along = direction * direction.transpose() / (2 * direction.squaredNorm());
    auto& V = equations.V;
    const double start = V.diagonal().head<3>().sum();
    const double end = V.diagonal().tail<3>().sum();
    V.topLeftCorner<3, 3>() += start * along;
    V.bottomRightCorner<3, 3>() += end * along;
  }
};

}  // namespace plumbline
