// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/plucker.h"
#include "plumbline/optimization/problem.h"
#include "plumbline/optimization/robust_loss.h"

#include <memory>
#include <vector>

#include <ceres/cost_function.h>
#include <ceres/manifold.h>

// The residuals of this module as Ceres terms: the reference our own solvers are tested and
// measured against. In a library of its own (plumbline::ceres_reference), so that nothing else
// needs Ceres.

namespace plumbline {

// Rigid3 as seven numbers [qx qy qz qw tx ty tz]; Plus(x, delta) = exp(delta) x, delta = [w, v].
class LeftRigid3Manifold final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
};

// OrthonormalLine as six numbers [qx qy qz qw w1 w2]; Plus is Retract().
class OrthonormalLineManifold final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 6; }
  int TangentSize() const override { return 4; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
};

enum class CeresDerivatives {
  kAnalytic,   // those of residuals.h
  kAutomatic,  // of a second, plain formulation of the residuals
};

// Cost of one observation. Parameter blocks: pose (7), point (3) or line (6).
std::unique_ptr<ceres::CostFunction> MakePointCost(const RectifiedCamera& camera,
                                                   const PointMeasurement& measurement,
                                                   CeresDerivatives derivatives);
std::unique_ptr<ceres::CostFunction> MakeLineCost(const RectifiedCamera& camera,
                                                  const LineMeasurement& measurement,
                                                  CeresDerivatives derivatives);

struct CeresBaOptions {
  HuberThresholds huber;  // infinite: no loss function
  CeresDerivatives derivatives = CeresDerivatives::kAnalytic;
  int max_iterations = 50;
  double function_tolerance = 1e-6;
};

struct CeresBaResult {
  std::vector<Rigid3> poses;
  std::vector<Eigen::Vector3d> points;
  std::vector<OrthonormalLine> lines;
  double initial_cost = 0;
  double final_cost = 0;
  int iterations = 0;
};

// All observations of a problem in one solve with DENSE_SCHUR on one thread.
CeresBaResult SolveWithCeres(const BaProblem& problem, const CeresBaOptions& options);

}  // namespace plumbline
