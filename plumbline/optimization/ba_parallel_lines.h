// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/optimization/problem.h"
#include "plumbline/optimization/robust_loss.h"
#include "plumbline/optimization/schur_solver.h"

#include <cstddef>
#include <vector>

namespace plumbline {

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
