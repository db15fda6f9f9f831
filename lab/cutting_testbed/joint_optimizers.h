// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/line_cutting/cutting_problem.h"

#include <array>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Methods of maximizing log det over the ratios of all lines (second paper, 5.2 and Figure 4). All
// begin at full length and stop if no ratio changes by more than 1e-5 or the gradient inside the
// box is below 1e-4 (the criterion available in the method), after kMaxJointEvaluations at the
// latest.
enum class JointOptimizer {
  kFull,      // no cutting
  kGreedy,    // CuttingMethod::kGreedy
  kSweeps,    // CuttingMethod::kGreedySweeps
  kSpectral,  // CuttingMethod::kJoint
  kIpopt,     // interior point, limited-memory Hessian
  kSlsqp,     // NLopt: sequential quadratic programming (active sets)
  kMma,       // NLopt: method of moving asymptotes
  kLbfgs,     // NLopt: limited-memory variable metric with active bounds
};
constexpr auto EnumNames(std::type_identity<JointOptimizer>) {
  return std::array{std::pair{JointOptimizer::kFull, "full"},
                    std::pair{JointOptimizer::kGreedy, "greedy"},
                    std::pair{JointOptimizer::kSweeps, "greedy_sweeps"},
                    std::pair{JointOptimizer::kSpectral, "joint"},
                    std::pair{JointOptimizer::kIpopt, "ipopt"},
                    std::pair{JointOptimizer::kSlsqp, "nlopt_slsqp"},
                    std::pair{JointOptimizer::kMma, "nlopt_mma"},
                    std::pair{JointOptimizer::kLbfgs, "nlopt_lbfgs"}};
}

inline constexpr int kMaxJointEvaluations = 2000;

// log det as a function of the 2n ratios of the lines, with its gradient.
class JointObjective {
 public:
  JointObjective(const CuttingProblem& problem, CuttingInformation information)
      : problem_(problem), information_(information) {}

  double operator()(const Eigen::VectorXd& ratios, Eigen::VectorXd& gradient) const;
  Eigen::Index size() const { return 2 * static_cast<Eigen::Index>(problem_.lines.size()); }
  Eigen::VectorXd FullLength() const;

 private:
  const CuttingProblem& problem_;
  CuttingInformation information_;
};

Eigen::VectorXd RatiosOf(const std::vector<LineCut>& cuts);

// Returns the final ratios of the optimizer, each in [0, 1].
Eigen::VectorXd OptimizeJointly(const CuttingProblem& problem,
                                CuttingInformation information,
                                JointOptimizer optimizer);

// The parts of it that depend on other libraries.
Eigen::VectorXd MaximizeWithIpopt(const JointObjective& objective);
Eigen::VectorXd MaximizeWithNlopt(const JointObjective& objective, JointOptimizer optimizer);

}  // namespace plumbline
