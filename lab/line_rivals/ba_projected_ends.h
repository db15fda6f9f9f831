// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/line_rivals/ba_rival_lines.h"
#include "plumbline/tracking/projected_ends.h"

#include <array>

namespace plumbline {

// Lines in bundle adjustment under LineResidualKind::kProjectedEnds, for each parametrization.

// Ends of a line as functions of two points' coordinates.
struct PointEndsView {
  static constexpr int kDof = 6;
  Segment3 ends;
  Eigen::Vector3d direction;

  // Derivative by the parameters of a quantity with derivatives `by_start` and `by_end` by the
  // ends.
  Vector6d Row(const Eigen::Vector3d& by_start, const Eigen::Vector3d& by_end) const {
    Vector6d row;
    row << by_start, by_end;
    return row;
  }
};

// Ends of a line of four parameters, at fixed parameters along it.
struct LineEndsView {
  static constexpr int kDof = 4;
  Segment3 ends;
  Eigen::Matrix<double, 6, 4> J;  // of start and end with respect to the update

  Eigen::Vector4d Row(const Eigen::Vector3d& by_start, const Eigen::Vector3d& by_end) const {
    return J.topRows<3>().transpose() * by_start + J.bottomRows<3>().transpose() * by_end;
  }
};

template <class ViewOfEnds>
struct BaProjectedTerms {
  static constexpr int kDof = ViewOfEnds::kDof;
  using Term = ProjectedEndsTerm;
  using Place = Segment3;
  using View = ViewOfEnds;

  static Term MakeTerm(const RectifiedCamera& camera, const LineMeasurement& measurement) {
    return MakeProjectedEndsTerm(camera, measurement);
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
extern template struct BaProjectedTerms<PointEndsView>;
extern template struct BaProjectedTerms<LineEndsView>;

// A line and the parameters of its ends along it.
struct LineWithEnds {
  OrthonormalLine line;
  LineInterval interval;
};

// Line: BaLine or BaLineLeft, the owner of these parameters.
template <class Line>
struct BaProjectedLine : BaProjectedTerms<LineEndsView> {
  using State = LineWithEnds;

  static Place MakePlace(const State& state) {
    return SegmentOf(ToPlucker(state.line), state.interval);
  }
  static View MakeView(const State& state) {
    const BaLine::View line = Line::MakeView(state.line);
    Vector6d homogeneous;
    homogeneous << line.moment, line.direction;
    return {MakePlace(state), EndsJacobian(homogeneous, state.interval) * line.J};
  }
  static State Retract(const State& state, const Eigen::Vector4d& step) {
    return {Line::Retract(state.line, step), state.interval};
  }
};

struct BaProjectedEnds : BaProjectedTerms<PointEndsView> {
  using State = Segment3;

  static Place MakePlace(const State& state) { return state; }
  static View MakeView(const State& state) { return {state, state.end - state.start}; }
  static State Retract(const State& state, const Vector6d& step) {
    return BaLineEnds::Retract(state, step);
  }
  // An end that slides along the line changes its residuals only by the noise of the measured
  // lines. Steps along it are damped as in BaLineEnds, so that ends drift instead of jumping to the
  // point of best agreement of the measured lines: both to the same point, in the middle of the
  // measurements. Nothing draws them back.
  static void HoldGauge(const View& view, LandmarkEquations<kDof>& equations) {
    BaLineEnds::HoldAlong(view.direction, equations);
  }
};

// One end of a line as a landmark of its own: with projected ends and a diagonal covariance, the
// two ends of a segment share no residual, and its 6 x 6 block splits into two of 3 x 3. Each end
// then has a loss of its own.
struct BaLineEnd {
  static constexpr int kDof = 3;
  struct State {
    Eigen::Vector3d point;
    Eigen::Vector3d direction;  // of the line at the start, along which steps are damped
  };
  struct Term {
    Eigen::Vector3d line = Eigen::Vector3d::Zero();  // as in ProjectedEndsTerm, whitened
    double shift = 0;
  };
  using Place = Eigen::Vector3d;
  using View = State;

  // The terms of the start and of the end. The covariance must be diagonal.
  static std::array<Term, 2> MakeTerms(const RectifiedCamera& camera,
                                       const LineMeasurement& measurement);
  static Place MakePlace(const State& state) { return state.point; }
  static View MakeView(const State& state) { return state; }
  static State Retract(const State& state, const Eigen::Vector3d& step) {
    return {state.point + step, state.direction};
  }
  static double Huber(const Term&, const HuberThresholds& huber) { return huber.line; }
  static int Dof(const Term&) { return 1; }
  static void HoldGauge(const View& view, LandmarkEquations<kDof>& equations) {
    const Eigen::Vector3d& d = view.direction;
    const double size = equations.V.diagonal().sum();
    equations.V += size / (2 * d.squaredNorm()) * d * d.transpose();
  }
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

}  // namespace plumbline
