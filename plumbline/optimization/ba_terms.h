// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/optimization/problem.h"
#include "plumbline/optimization/residuals.h"
#include "plumbline/optimization/schur_solver.h"

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace plumbline {

// Parameters, residual and part of the normal equations of each kind of landmark in bundle
// adjustment. Internal to bundle_adjuster.h.

struct BaPose {
  Rigid3 cam_from_world;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  int free_index = -1;  // -1 for a fixed pose

  void Set(const Rigid3& value) {
    cam_from_world = value;
    R = value.rotation.toRotationMatrix();
  }
  // Returns a point of the world in the frame of the camera.
  Eigen::Vector3d ToCamera(const Eigen::Vector3d& point) const {
    return R * point + cam_from_world.translation;
  }
};

struct BaPoint {
  static constexpr int kDof = 3;
  using State = Eigen::Vector3d;
  using Term = PointTerm;
  // Place is the form of a state for residuals, View that for their derivatives. Both are computed
  // once for all observations of the landmark.
  using Place = Eigen::Vector3d;
  using View = Eigen::Vector3d;

  static Place MakePlace(const State& state) { return state; }
  static View MakeView(const State& state) { return state; }
  static State Retract(const State& state, const Eigen::Vector3d& step) { return state + step; }
  // Returns the point that is at the same place in the camera after the pose has moved.
  static State Carried(const State& state, const BaPose& before, const BaPose& after) {
    return after.R.transpose() * (before.ToCamera(state) - after.cam_from_world.translation);
  }
  static double Huber(const Term& term, const HuberThresholds& huber) {
    return term.disparity_weight > 0 ? huber.disparity : huber.point;
  }
  static int Dof(const Term& term) { return term.disparity_weight > 0 ? 3 : 2; }
  // Returns the squared norm of the whitened residual; infinite if it is not defined.
  static double Chi2(const RectifiedCamera& camera,
                     const BaPose& pose,
                     const Place& place,
                     const Term& term) {
    return PointChi2(camera, term, pose.ToCamera(place))
        .value_or(std::numeric_limits<double>::infinity());
  }

  using Target = BaTarget<kDof>;
  // Adds an observation to the equations. Returns false and adds nothing if its residual is not
  // defined.
  static bool Add(const RectifiedCamera& camera,
                  const BaPose& pose,
                  const View& view,
                  const Term& term,
                  double huber,
                  const Target& target);
};

// A line in the world, of any scale, since residuals depend on moment : direction alone.
struct BaLinePlace {
  Eigen::Vector3d moment, direction;
};

// A line and its derivative with respect to the parameters of its update.
template <int kParameters>
struct BaLineView : BaLinePlace {
  Eigen::Matrix<double, 6, kParameters> J;  // derivative of moment and direction
};

// Common part of lines of all parametrizations: two residuals in each image, the distances of the
// measured ends from the projected line.
struct BaMeasuredLine {
  using Term = LineTerm;
  using Place = BaLinePlace;

  static Term MakeTerm(const RectifiedCamera& camera, const LineMeasurement& measurement) {
    return MakeLineTerm(camera, measurement);
  }
  static double Huber(const Term&, const HuberThresholds& huber) { return huber.line; }
  static int Dof(const Term&) { return 2; }
  // Returns the squared norm of the whitened distances; infinite if the line has no projection.
  static double Chi2(const RectifiedCamera& camera,
                     const BaPose& pose,
                     const Place& line,
                     const Term& term);
};

struct BaLine : BaMeasuredLine {
  static constexpr int kDof = 4;
  using State = OrthonormalLine;
  using View = BaLineView<kDof>;

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

  using Target = BaTarget<kDof>;
  static bool Add(const RectifiedCamera& camera,
                  const BaPose& pose,
                  const View& view,
                  const Term& term,
                  double huber,
                  const Target& target);
};

// A line in the camera that measured it.
struct BaLineInCamera {
  Eigen::Vector3d t;  // translation of the measuring camera
  Eigen::Vector3d direction, moment;

  BaLineInCamera(const BaPose& pose, const BaLinePlace& line, double shift)
      : t(pose.cam_from_world.translation) {
    t.x() += shift;
    direction = pose.R * line.direction;
    moment = pose.R * line.moment + t.cross(direction);
  }
};

// Implements BaLine::Add for lines with any parametrization.
template <int kDof>
bool AddMeasuredLine(const RectifiedCamera& camera,
                     const BaPose& pose,
                     const BaLineView<kDof>& view,
                     const LineTerm& term,
                     double huber,
                     const BaTarget<kDof>& target) {
  const BaLineInCamera line(pose, view, term.shift);
  LineLinearization a;
  if (!LinearizeLine(camera, term, line.moment, a)) return false;
  const double w = HuberWeight(a.r.squaredNorm(), huber);
  Vector6d b0;
  Vector6d b1;
  b0 << pose.R.transpose() * a.h0, pose.R.transpose() * a.h0.cross(line.t);  // eq. 18
  b1 << pose.R.transpose() * a.h1, pose.R.transpose() * a.h1.cross(line.t);
  using Row = Eigen::Matrix<double, kDof, 1>;
  const Row c0 = view.J.transpose() * b0;
  const Row c1 = view.J.transpose() * b1;
  AddTwoRows<kDof>(w, a.r, c0, c1, target, [&] {
    return std::pair(LinePoseRow(a.h0, line.moment, line.direction, term.shift),
                     LinePoseRow(a.h1, line.moment, line.direction, term.shift));
  });
  return true;
}

// Residuals of the parallel lines of a problem: weight x and weight y of a line's unit direction
// (x, y, z) in a frame with the axis as its z. The axes are constant, so that each residual depends
// on one line and no pose. Internal to bundle_adjuster.h.
class BaParallelLines {
 public:
  BaParallelLines() = default;  // no parallel lines
  explicit BaParallelLines(const BaProblem& problem);

  // Returns the loss of a line's residuals in use. Its direction may have any length.
  double Loss(std::size_t line, const Eigen::Vector3d& direction, double huber) const;
  // Adds the residuals in use to the equations of a line. `J` is the derivative of moment and
  // direction.
  template <int kDof>
  void Add(std::size_t line,
           const Eigen::Vector3d& direction,
           const Eigen::Matrix<double, 6, kDof>& J,
           double huber,
           LandmarkEquations<kDof>& equations) const;

  // Stores the chi2 of a line with this direction, for Classify() and UseAll().
  void UpdateChi2(std::size_t line, const Eigen::Vector3d& direction);
  // Puts into use exactly the residuals whose chi2 is within the limit at 95 %. Returns true if
  // that changed any.
  bool Classify();
  // Puts into use all residuals that are finite.
  void UseAll();
  std::size_t used() const;
  std::size_t Bytes() const;

 private:
  struct Residual {
    Eigen::Matrix3d axis_from_world;
    double weight = 1;
    double chi2 = 0;
    bool used = true;
  };

  std::vector<std::size_t> begin_;   // first residual of each line, then the end
  std::vector<Residual> residuals_;  // residuals ordered by line
};

template <int kDof>
void BaParallelLines::Add(std::size_t line,
                          const Eigen::Vector3d& direction,
                          const Eigen::Matrix<double, 6, kDof>& J,
                          double huber,
                          LandmarkEquations<kDof>& equations) const {
  if (residuals_.empty()) return;
  const double scale = 1 / direction.norm();
  for (std::size_t k = begin_[line]; k < begin_[line + 1]; ++k) {
    const auto& [R, weight, chi2, used] = residuals_[k];
    if (!used) continue;
    const Eigen::Vector3d d = scale * (R * direction);
    const Eigen::Vector2d r = weight * d.head<2>();
    const double w = HuberWeight(r.squaredNorm(), huber);
    // A change along the direction does not turn it.
    const Eigen::Matrix<double, 3, kDof> moved = scale * weight * R * J.template bottomRows<3>();
    const Eigen::Matrix<double, 2, kDof> J_r =
        moved.template topRows<2>() - d.head<2>() * (d.transpose() * moved);
    equations.V.noalias() += w * J_r.transpose() * J_r;
    equations.g.noalias() += w * J_r.transpose() * r;
  }
}

}  // namespace plumbline
