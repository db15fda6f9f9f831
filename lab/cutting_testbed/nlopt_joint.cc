// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/cutting_testbed/joint_optimizers.h"
#include "plumbline/base/error.h"

#include <cstddef>
#include <exception>
#include <vector>

#include <nlopt.hpp>

namespace plumbline {
namespace {

nlopt::algorithm AlgorithmOf(JointOptimizer optimizer) {
  if (optimizer == JointOptimizer::kSlsqp) return nlopt::LD_SLSQP;
  if (optimizer == JointOptimizer::kMma) return nlopt::LD_MMA;
  PLUMBLINE_CHECK(optimizer == JointOptimizer::kLbfgs, "not one of NLopt's");
  return nlopt::LD_LBFGS;
}

double Evaluate(const std::vector<double>& ratios, std::vector<double>& gradient, void* data) {
  const auto& objective = *static_cast<const JointObjective*>(data);
  const auto size = static_cast<Eigen::Index>(ratios.size());
  Eigen::VectorXd slopes;
  const double value = objective(Eigen::Map<const Eigen::VectorXd>(ratios.data(), size), slopes);
  if (!gradient.empty()) Eigen::Map<Eigen::VectorXd>(gradient.data(), size) = slopes;
  return value;
}

}  // namespace

Eigen::VectorXd MaximizeWithNlopt(const JointObjective& objective, JointOptimizer optimizer) {
  nlopt::opt search(AlgorithmOf(optimizer), static_cast<unsigned>(objective.size()));
  search.set_lower_bounds(0);
  search.set_upper_bounds(1);
  search.set_xtol_abs(1e-5);
  search.set_maxeval(kMaxJointEvaluations);
  // The objective is not changed; the interface knows no constant data.
  search.set_max_objective(Evaluate, const_cast<JointObjective*>(&objective));
  const Eigen::VectorXd full = objective.FullLength();
  std::vector<double> ratios(full.begin(), full.end());
  double value = 0;
  try {
    search.optimize(ratios, value);
  } catch (const nlopt::roundoff_limited&) {
    // It can get no further; `ratios` are the best it has.
  } catch (const std::runtime_error&) {
    // A generic failure of the method: likewise.
  }
  return Eigen::Map<const Eigen::VectorXd>(ratios.data(), objective.size());
}

}  // namespace plumbline
