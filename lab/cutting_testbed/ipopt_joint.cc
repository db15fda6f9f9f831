// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/cutting_testbed/joint_optimizers.h"
#include "plumbline/base/error.h"

#include <coin/IpIpoptApplication.hpp>
#include <coin/IpTNLP.hpp>

namespace plumbline {
namespace {

using Ipopt::Index;
using Ipopt::Number;

// Ratios in a box, no constraints, -log det to be minimized.
class CuttingProgram : public Ipopt::TNLP {
 public:
  explicit CuttingProgram(const JointObjective& objective)
      : objective_(objective), best_(objective.FullLength()) {}

  const Eigen::VectorXd& best() const { return best_; }

  bool get_nlp_info(
      Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) override {
    n = static_cast<Index>(objective_.size());
    m = jacobian = hessian = 0;
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(Index n, Number* low, Number* high, Index, Number*, Number*) override {
    Eigen::Map<Eigen::VectorXd>(low, n).setZero();
    Eigen::Map<Eigen::VectorXd>(high, n).setOnes();
    return true;
  }
  bool get_starting_point(
      Index n, bool, Number* x, bool, Number*, Number*, Index, bool, Number*) override {
    Eigen::Map<Eigen::VectorXd>(x, n) = objective_.FullLength();
    return true;
  }
  bool eval_f(Index n, const Number* x, bool, Number& value) override {
    Eigen::VectorXd gradient;
    value = -objective_(Eigen::Map<const Eigen::VectorXd>(x, n), gradient);
    return true;
  }
  bool eval_grad_f(Index n, const Number* x, bool, Number* out) override {
    Eigen::VectorXd gradient;
    objective_(Eigen::Map<const Eigen::VectorXd>(x, n), gradient);
    Eigen::Map<Eigen::VectorXd>(out, n) = -gradient;
    return true;
  }
  bool eval_g(Index, const Number*, bool, Index, Number*) override { return true; }
  bool eval_jac_g(Index, const Number*, bool, Index, Index, Index*, Index*, Number*) override {
    return true;
  }
  void finalize_solution(Ipopt::SolverReturn,
                         Index n,
                         const Number* x,
                         const Number*,
                         const Number*,
                         Index,
                         const Number*,
                         const Number*,
                         Number,
                         const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    best_ = Eigen::Map<const Eigen::VectorXd>(x, n).cwiseMax(0.0).cwiseMin(1.0);
  }

 private:
  const JointObjective& objective_;
  Eigen::VectorXd best_;
};

}  // namespace

Eigen::VectorXd MaximizeWithIpopt(const JointObjective& objective) {
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);
  application->Options()->SetIntegerValue("print_level", 0);
  application->Options()->SetStringValue("sb", "yes");
  application->Options()->SetStringValue("hessian_approximation", "limited-memory");
  application->Options()->SetNumericValue("tol", 1e-4);
  application->Options()->SetIntegerValue("max_iter", kMaxJointEvaluations);
  PLUMBLINE_CHECK(application->Initialize("") == Ipopt::Solve_Succeeded, "Ipopt does not start");
  const Ipopt::SmartPtr<CuttingProgram> program = new CuttingProgram(objective);
  application->OptimizeTNLP(GetRawPtr(program));
  return program->best();
}

}  // namespace plumbline
