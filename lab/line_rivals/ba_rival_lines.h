// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"
#include "plumbline/optimization/ba_terms.h"

namespace plumbline {

// Other parameters of lines in bundle adjustment, under the residual of BaLine.

// A line by four parameters that rotate it about the axes of the frame (PPL-SLAM). Undamped steps
// are those of BaLine to first order; the damping uses other diagonal entries, and the step is
// taken along the arc.
struct BaLineLeft : BaLine {
  static View MakeView(const State& state) {
    return {MakePlace(state), LeftHomogeneousJacobian(state)};
  }
  static State Retract(const State& state, const Eigen::Vector4d& step) {
    return RetractLeft(state, step);
  }
};

// A line as two of its points, each with its three coordinates in the world.
struct BaLineEnds : BaMeasuredLine {
  static constexpr int kDof = 6;
  using State = Segment3;
  using View = BaLineView<kDof>;
  using Target = BaTarget<kDof>;

  static bool Add(const RectifiedCamera& camera,
                  const BaPose& pose,
                  const View& view,
                  const Term& term,
                  double huber,
                  const Target& target) {
    return AddMeasuredLine<kDof>(camera, pose, view, term, huber, target);
  }

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
  // Residuals do not depend on an end that slides along the line. Information of the same size as
  // that across the line is added along it: a slide then is determined, and the rest of the step
  // unchanged, since the equations require no slide (their g has no part along it).
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
