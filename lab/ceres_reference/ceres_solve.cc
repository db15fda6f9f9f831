// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/ceres_reference/ceres_solve.h"

#include "lab/ceres_reference/ceres_manifolds.h"
#include "lab/ceres_reference/ceres_terms.h"
#include "lab/line_rivals/line_ends.h"
#include "plumbline/base/error.h"
#include "plumbline/base/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include <ceres/loss_function.h>
#include <ceres/ordered_groups.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

namespace plumbline {
namespace {

// Options common to both solvers: one thread, termination by iterations or by the cost alone.
ceres::Solver::Options CommonOptions(int max_iterations, double function_tolerance) {
  ceres::Solver::Options solver;
  solver.num_threads = 1;
  solver.jacobi_scaling = false;  // same steps, 6 % less time
  solver.max_num_iterations = max_iterations;
  solver.function_tolerance = function_tolerance;
  solver.parameter_tolerance = 0;
  solver.gradient_tolerance = 0;
  solver.logging_type = ceres::SILENT;
  return solver;
}

using PoseBlock = std::array<double, 7>;
using LineBlock = std::array<double, 6>;

void WriteEnds(const Segment3& ends, LineBlock& x) {
  std::copy_n(ends.start.data(), 3, x.begin());
  std::copy_n(ends.end.data(), 3, x.begin() + 3);
}

Segment3 ReadEnds(const LineBlock& x) {
  return {Eigen::Map<const Eigen::Vector3d>(x.data()),
          Eigen::Map<const Eigen::Vector3d>(x.data() + 3)};
}

std::unique_ptr<ceres::LossFunction> MakeLoss(double huber) {
  if (!std::isfinite(huber)) return nullptr;
  return std::make_unique<ceres::HuberLoss>(huber);
}

struct Losses {
  explicit Losses(const HuberThresholds& huber)
      : point(MakeLoss(huber.point)),
        disparity(MakeLoss(huber.disparity)),
        line(MakeLoss(huber.line)) {}
  std::unique_ptr<ceres::LossFunction> point, disparity, line;
};

ceres::Problem::Options SharedParts(ceres::Ownership costs) {
  ceres::Problem::Options options;
  options.cost_function_ownership = costs;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.disable_all_safety_checks = true;
  return options;
}

// A problem in the numbers Ceres works on.
class CeresBa {
 public:
  CeresBa(const BaProblem& problem, const CeresBaOptions& options)
      : problem_(problem), options_(options), losses_(options.huber) {
    PLUMBLINE_CHECK(!HasProjectedEnds() || options.derivatives == CeresDerivatives::kAutomatic,
                    "projected ends need automatic derivatives");
    MakeManifolds();
    AddBlocks();
    AddTerms();
  }

  CeresBaResult Solve();

 private:
  bool HasEnds() const { return options_.lines.parametrization == LineParametrization::kEndpoints; }
  bool HasProjectedEnds() const {
    return options_.lines.residual == LineResidualKind::kProjectedEnds;
  }
  std::unique_ptr<ceres::CostFunction> LineCost(const BaProblem::LineObservation& o) const;
  void MakeManifolds();
  void AddBlocks();
  void AddTerms();

  const BaProblem& problem_;
  const CeresBaOptions& options_;
  const Losses losses_;
  std::unique_ptr<ceres::Manifold> pose_manifold_, line_manifold_;
  std::vector<PoseBlock> poses_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<LineBlock> lines_;
  std::vector<Segment3> ends_;  // of the lines at the start
  ceres::Problem terms_{SharedParts(ceres::TAKE_OWNERSHIP)};
  std::shared_ptr<ceres::ParameterBlockOrdering> order_ =
      std::make_shared<ceres::ParameterBlockOrdering>();
};

void CeresBa::MakeManifolds() {
  if (options_.derivatives == CeresDerivatives::kAnalytic) {
    pose_manifold_ = std::make_unique<TangentManifold<LeftRigid3Manifold>>();
    line_manifold_ = std::make_unique<StraightLineManifold>();
    if (options_.lines.parametrization == LineParametrization::kPluckerLeft) {
      line_manifold_ = std::make_unique<TangentManifold<LeftOrthonormalLineManifold>>();
    }
  } else {
    pose_manifold_ = std::make_unique<LeftRigid3Manifold>();
    line_manifold_ = std::make_unique<OrthonormalLineManifold>();
    if (options_.lines.parametrization == LineParametrization::kPluckerLeft) {
      line_manifold_ = std::make_unique<LeftOrthonormalLineManifold>();
    }
  }
  if (HasEnds()) line_manifold_.reset();
}

void CeresBa::AddBlocks() {
  constexpr int kLandmarks = 0;  // eliminated first
  constexpr int kPoses = 1;
  poses_.resize(problem_.poses.size());
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    WritePose(problem_.poses[i].cam_from_world, poses_[i].data());
    terms_.AddParameterBlock(poses_[i].data(), 7, pose_manifold_.get());
    if (problem_.poses[i].fixed) terms_.SetParameterBlockConstant(poses_[i].data());
    order_->AddElementToGroup(poses_[i].data(), kPoses);
  }
  points_ = problem_.points;
  for (auto& point : points_) {
    terms_.AddParameterBlock(point.data(), 3);
    order_->AddElementToGroup(point.data(), kLandmarks);
  }
  if (HasEnds()) {
    ends_ = EndsOf(problem_);
  } else if (HasProjectedEnds()) {
    ends_ = TrimmedEnds(problem_);
  }
  lines_.resize(problem_.lines.size());
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (HasEnds()) {
      WriteEnds(ends_[i], lines_[i]);
    } else {
      WriteLine(problem_.lines[i], lines_[i].data());
    }
    terms_.AddParameterBlock(lines_[i].data(), 6, line_manifold_.get());
    order_->AddElementToGroup(lines_[i].data(), kLandmarks);
  }
}

void CeresBa::AddTerms() {
  for (const auto& o : problem_.point_observations) {
    terms_.AddResidualBlock(
        MakePointCost(problem_.camera, o.measurement, options_.derivatives).release(),
        (o.measurement.disparity ? losses_.disparity : losses_.point).get(),
        poses_[static_cast<std::size_t>(o.pose)].data(),
        points_[static_cast<std::size_t>(o.point)].data());
  }
  for (const auto& o : problem_.line_observations) {
    terms_.AddResidualBlock(LineCost(o).release(),
                            losses_.line.get(),
                            poses_[static_cast<std::size_t>(o.pose)].data(),
                            lines_[static_cast<std::size_t>(o.line)].data());
  }
}

std::unique_ptr<ceres::CostFunction> CeresBa::LineCost(const BaProblem::LineObservation& o) const {
  if (!HasProjectedEnds()) {
    return MakeLineCost(
        problem_.camera, o.measurement, options_.derivatives, options_.lines.parametrization);
  }
  const auto i = static_cast<std::size_t>(o.line);
  const PluckerLine line = ToPlucker(problem_.lines[i]);
  return MakeProjectedEndsCost(problem_.camera,
                               o.measurement,
                               options_.lines.parametrization,
                               {line.ParameterOf(ends_[i].start), line.ParameterOf(ends_[i].end)});
}

CeresBaResult CeresBa::Solve() {
  ceres::Solver::Options solver =
      CommonOptions(options_.max_iterations, options_.function_tolerance);
  // Damping never below 1e-9, as in our solver: the free slides of end points would make the
  // equations singular.
  solver.max_trust_region_radius = 1e9;
  solver.linear_solver_type = ceres::DENSE_SCHUR;
  solver.linear_solver_ordering = order_;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &terms_, &summary);
  CeresBaResult result;
  for (const auto& x : poses_) result.poses.push_back(ReadPose(x.data()));
  result.points = points_;
  if (HasEnds()) {
    std::vector<Segment3> moved;
    for (const auto& x : lines_) moved.push_back(ReadEnds(x));
    result.lines = LinesThroughEnds(problem_.lines, ends_, moved);
  } else {
    for (const auto& x : lines_) result.lines.push_back(ReadLine(x.data()));
  }
  result.initial_cost = summary.initial_cost;
  result.final_cost = summary.final_cost;
  result.iterations = static_cast<int>(summary.iterations.size()) - 1;
  return result;
}

// The terms of a pose problem, each with its input of the classification.
class CeresPose {
 public:
  explicit CeresPose(const PoseProblem& problem) : problem_(problem) {
    for (const auto& match : problem.points) {
      point_costs_.push_back(MakePosePointCost(problem.camera, match));
    }
    for (const auto& match : problem.lines) {
      line_costs_.push_back(MakePoseLineCost(problem.camera, match));
      limit_[match.group] = Chi2Limit95(2 * ++measurements_[match.group]);
    }
    point_used_.assign(point_costs_.size(), true);
    line_used_.assign(line_costs_.size(), true);
    WritePose(problem.cam_from_world, pose_.data());
  }

  CeresPoseResult Solve(const CeresPoseOptions& options);

 private:
  void SolveRound(const HuberThresholds& huber,
                  const CeresPoseOptions& options,
                  CeresPoseResult& result);
  void Classify(CeresPoseResult& result);
  double Chi2(const ceres::CostFunction& cost) const;

  const PoseProblem& problem_;
  std::vector<std::unique_ptr<ceres::CostFunction>> point_costs_, line_costs_;
  std::vector<bool> point_used_, line_used_;
  std::map<int, int> measurements_;  // of each group
  std::map<int, double> limit_;
  PoseBlock pose_{};
};

double CeresPose::Chi2(const ceres::CostFunction& cost) const {
  Eigen::Vector3d r = Eigen::Vector3d::Zero();
  const double* x = pose_.data();
  const bool valid = cost.Evaluate(&x, r.data(), nullptr);
  return valid ? r.squaredNorm() : std::numeric_limits<double>::infinity();
}

void CeresPose::SolveRound(const HuberThresholds& huber,
                           const CeresPoseOptions& options,
                           CeresPoseResult& result) {
  const Losses losses(huber);
  TangentManifold<LeftRigid3Manifold> manifold;
  ceres::Problem terms(SharedParts(ceres::DO_NOT_TAKE_OWNERSHIP));
  terms.AddParameterBlock(pose_.data(), 7, &manifold);
  for (std::size_t i = 0; i < point_costs_.size(); ++i) {
    if (!point_used_[i]) continue;
    const bool disparity = problem_.points[i].measurement.disparity.has_value();
    terms.AddResidualBlock(
        point_costs_[i].get(), (disparity ? losses.disparity : losses.point).get(), pose_.data());
  }
  for (std::size_t i = 0; i < line_costs_.size(); ++i) {
    if (!line_used_[i]) continue;
    terms.AddResidualBlock(line_costs_[i].get(), losses.line.get(), pose_.data());
  }
  ceres::Solver::Options solver = CommonOptions(options.max_iterations, options.function_tolerance);
  solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &terms, &summary);
  result.final_cost = summary.final_cost;
  result.iterations += static_cast<int>(summary.iterations.size()) - 1;
}

void CeresPose::Classify(CeresPoseResult& result) {
  result.inlier_points = 0;
  result.inlier_line_groups = 0;
  for (std::size_t i = 0; i < point_costs_.size(); ++i) {
    const int dof = problem_.points[i].measurement.disparity ? 3 : 2;
    point_used_[i] = Chi2(*point_costs_[i]) <= Chi2Limit95(dof);
    result.inlier_points += point_used_[i];
  }
  std::map<int, double> chi2;
  for (std::size_t i = 0; i < line_costs_.size(); ++i) {
    chi2[problem_.lines[i].group] += Chi2(*line_costs_[i]);
  }
  for (const auto& [group, value] : chi2) result.inlier_line_groups += value <= limit_[group];
  for (std::size_t i = 0; i < line_costs_.size(); ++i) {
    const int group = problem_.lines[i].group;
    line_used_[i] = chi2[group] <= limit_[group];
  }
}

CeresPoseResult CeresPose::Solve(const CeresPoseOptions& options) {
  CeresPoseResult result;
  for (int round = 0; round < options.rounds; ++round) {
    SolveRound(round < options.robust_rounds ? options.huber : HuberThresholds{}, options, result);
    Classify(result);
  }
  result.cam_from_world = ReadPose(pose_.data());
  return result;
}

}  // namespace

CeresBaResult SolveWithCeres(const BaProblem& problem, const CeresBaOptions& options) {
  PLUMBLINE_CHECK(problem.parallel_lines.empty(), "parallel lines have no reference");
  return CeresBa(problem, options).Solve();
}

CeresPoseResult SolvePoseWithCeres(const PoseProblem& problem, const CeresPoseOptions& options) {
  return CeresPose(problem).Solve(options);
}

}  // namespace plumbline
