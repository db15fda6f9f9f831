// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/cutting_testbed/joint_optimizers.h"

#include "lab/rivals/cutting_methods.h"
#include "plumbline/base/error.h"
#include "plumbline/line_cutting/pose_information.h"

namespace plumbline {

double JointObjective::operator()(const Eigen::VectorXd& ratios, Eigen::VectorXd& gradient) const {
  std::vector<LineCut> cuts(problem_.lines.size());
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    const auto k = 2 * static_cast<Eigen::Index>(i);
    cuts[i] = {ratios(k), ratios(k + 1)};
  }
  return LogDeterminantOf(problem_, cuts, information_, &gradient);
}

Eigen::VectorXd JointObjective::FullLength() const {
  return RatiosOf(std::vector<LineCut>(problem_.lines.size()));
}

Eigen::VectorXd RatiosOf(const std::vector<LineCut>& cuts) {
  Eigen::VectorXd ratios(2 * static_cast<Eigen::Index>(cuts.size()));
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    ratios.segment<2>(2 * static_cast<Eigen::Index>(i)) << cuts[i].first, cuts[i].second;
  }
  return ratios;
}

Eigen::VectorXd OptimizeJointly(const CuttingProblem& problem,
                                CuttingInformation information,
                                JointOptimizer optimizer) {
  const JointObjective objective(problem, information);
  const auto cut = [&](CuttingMethod method) {
    return RatiosOf(CutLinesBy({method, information}, problem));
  };
  switch (optimizer) {
    case JointOptimizer::kFull:
      return objective.FullLength();
    case JointOptimizer::kGreedy:
      return cut(CuttingMethod::kGreedy);
    case JointOptimizer::kSweeps:
      return cut(CuttingMethod::kGreedySweeps);
    case JointOptimizer::kSpectral:
      return cut(CuttingMethod::kJoint);
    case JointOptimizer::kIpopt:
      return MaximizeWithIpopt(objective);
    case JointOptimizer::kSlsqp:
    case JointOptimizer::kMma:
    case JointOptimizer::kLbfgs:
      return MaximizeWithNlopt(objective, optimizer);
  }
  throw BugError("no such optimizer");
}

}  // namespace plumbline
