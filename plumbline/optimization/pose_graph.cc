// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/pose_graph.h"

#include "plumbline/base/error.h"
#include "plumbline/base/ids.h"
#include "plumbline/optimization/multifrontal_cholesky.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

namespace plumbline {
namespace {

constexpr int kMaxSteps = 20;  // Gauss-Newton steps in all
// The iteration ends if no component of a step is larger: radians, map scale, log scale.
constexpr double kStepTolerance = 1e-6;
// An edge that may be wrong is right when its squared Mahalanobis norm is below this.
constexpr double kRightChi2 = 24.3;

// Returns the inverse of the left Jacobian of sim(3) for the residual of an edge. Near zero this is
// the Bernoulli series in ad(x) up to its fourth power, which is exact to 1e-8 there.
Matrix7d InverseLeftJacobian(const Vector7d& x) {
  constexpr double kSmall = 0.3;
  if (x.head<3>().norm() + x.segment<3>(3).norm() + std::abs(x(6)) > kSmall) {
    return InverseLeftJacobianSim3(x);
  }
  Matrix7d ad = Matrix7d::Zero();
  ad.topLeftCorner<3, 3>() = Skew(x.head<3>());
  ad.block<3, 3>(3, 0) = Skew(x.segment<3>(3));
  ad.block<3, 3>(3, 3) = ad.topLeftCorner<3, 3>() + x(6) * Eigen::Matrix3d::Identity();
  ad.block<3, 1>(3, 6) = -x.segment<3>(3);
  const Matrix7d squared = ad * ad;
  return Matrix7d::Identity() - ad / 2 + squared / 12 - squared * squared / 720;
}

// Damping of the system, which fixes poses without edges. It is far below the information of any
// edge.
constexpr double kDamping = 1e-9;

// A Gauss-Newton problem over the free poses, with kSize degrees of freedom for each.
template <int kSize>
class System {
 public:
  using Block = Eigen::Matrix<double, kSize, kSize>;
  using Vector = Eigen::Matrix<double, kSize, 1>;

  explicit System(const PoseGraph& graph)
      : graph_(graph), row_of_(Rows(graph)), cholesky_(PlanElimination(Pattern())) {}

  // Adds the step to the poses and returns its largest component; nullopt if the system is
  // singular.
  std::optional<double> Step(const std::vector<double>& weights, std::vector<Similarity3>& poses) {
    Clear();
    for (std::size_t e = 0; e < graph_.edges.size(); ++e) {
      if (weights[e] > 0) Add(e, weights[e], poses);
    }
    Fill();
    if (!cholesky_.Factor()) return std::nullopt;
    Eigen::VectorXd step = -gradient_;
    cholesky_.Solve(step);
    if (!step.allFinite()) return std::nullopt;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (row_of_[i] < 0) continue;
      Vector7d tangent = Vector7d::Zero();
      tangent.head<kSize>() = step.segment<kSize>(kSize * row_of_[i]);
      poses[i] = RetractLeft(poses[i], tangent);
      poses[i].rotation.normalize();
    }
    return step.size() == 0 ? 0 : step.lpNorm<Eigen::Infinity>();
  }

 private:
  static std::vector<int> Rows(const PoseGraph& graph) {
    std::vector<int> rows(graph.poses.size(), -1);
    int next = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (!graph.fixed[i]) rows[i] = next++;
    }
    return rows;
  }

  BlockPattern Pattern() {
    const auto free = std::count_if(row_of_.begin(), row_of_.end(), [](int r) { return r >= 0; });
    diagonal_.resize(static_cast<std::size_t>(free));
    BlockPattern pattern(diagonal_.size());
    for (const PoseGraphEdge& edge : graph_.edges) {
      const auto [high, low] = Place(edge);
      if (low >= 0 && high != low) pattern[Index(high)].push_back(low);
    }
    for (std::size_t row = 0; row < pattern.size(); ++row) {
      std::sort(pattern[row].begin(), pattern[row].end());
      pattern[row].erase(std::unique(pattern[row].begin(), pattern[row].end()), pattern[row].end());
      for (const int column : pattern[row]) places_.emplace_back(static_cast<int>(row), column);
    }
    off_diagonal_.resize(places_.size());
    for (const PoseGraphEdge& edge : graph_.edges) {
      const auto place = std::lower_bound(places_.begin(), places_.end(), Place(edge));
      place_of_.push_back(static_cast<std::size_t>(place - places_.begin()));
    }
    return pattern;
  }

  // Returns row and column of the block that couples the poses of an edge. The column is -1 if one
  // of the poses is fixed.
  std::pair<int, int> Place(const PoseGraphEdge& edge) const {
    const int a = row_of_[Index(edge.to)];
    const int b = row_of_[Index(edge.from)];
    return {std::max(a, b), std::min(a, b)};
  }

  void Clear() {
    for (Block& block : diagonal_) block.setZero();
    for (Block& block : off_diagonal_) block.setZero();
    gradient_.setZero(kSize * static_cast<Eigen::Index>(diagonal_.size()));
  }

  void Add(std::size_t e, double weight, const std::vector<Similarity3>& poses) {
    const PoseGraphEdge& edge = graph_.edges[e];
    const Similarity3& to = poses[Index(edge.to)];
    const Similarity3& from = poses[Index(edge.from)];
    const Vector7d full = PoseGraphResidual(edge, to, from);
    const Vector r = full.head<kSize>();
    const Block J_to = InverseLeftJacobian(full).template topLeftCorner<kSize, kSize>();
    const Matrix7d across = Adjoint(to * Inverse(from));
    const Block J_from = -J_to * across.template topLeftCorner<kSize, kSize>();
    const Block information = weight * edge.information.template topLeftCorner<kSize, kSize>();
    const Block to_information = J_to.transpose() * information;
    const Block from_information = J_from.transpose() * information;
    const int a = row_of_[Index(edge.to)];
    const int b = row_of_[Index(edge.from)];
    if (a >= 0) {
      diagonal_[Index(a)] += to_information * J_to;
      gradient_.segment<kSize>(kSize * a) += to_information * r;
    }
    if (b >= 0) {
      diagonal_[Index(b)] += from_information * J_from;
      gradient_.segment<kSize>(kSize * b) += from_information * r;
    }
    if (a < 0 || b < 0) return;
    const Block coupling = to_information * J_from;
    if (a > b) {
      off_diagonal_[place_of_[e]] += coupling;
    } else {
      off_diagonal_[place_of_[e]] += coupling.transpose();
    }
  }

  void Fill() {
    cholesky_.Clear();
    for (std::size_t row = 0; row < diagonal_.size(); ++row) {
      Block block = diagonal_[row];
      block.diagonal().array() += kDamping;
      cholesky_.Set(static_cast<int>(row), static_cast<int>(row), block);
    }
    for (std::size_t i = 0; i < places_.size(); ++i) {
      cholesky_.Set(places_[i].first, places_[i].second, off_diagonal_[i]);
    }
  }

  const PoseGraph& graph_;
  std::vector<int> row_of_;  // row of each pose; -1 for a fixed pose
  std::vector<Block> diagonal_;
  // Row and column of each block left of the diagonal.
  std::vector<std::pair<int, int>> places_;
  std::vector<Block> off_diagonal_;  // the block at each of places_
  // Index in places_ for each edge; undefined if one pose is fixed.
  std::vector<std::size_t> place_of_;
  Eigen::VectorXd gradient_;
  BlockCholesky<kSize> cholesky_;
};

std::vector<double> Chi2(const PoseGraph& graph, const std::vector<Similarity3>& poses) {
  std::vector<double> chi2;
  chi2.reserve(graph.edges.size());
  const int size = graph.motion == PoseGraphMotion::kRigid ? 6 : 7;
  for (const PoseGraphEdge& edge : graph.edges) {
    const Vector7d r = PoseGraphResidual(edge, poses[Index(edge.to)], poses[Index(edge.from)]);
    chi2.push_back(r.head(size).dot(edge.information.topLeftCorner(size, size) * r.head(size)));
  }
  return chi2;
}

// Returns the weight of a residual under the truncated squares made convex by mu (Yang et al.).
double Weight(double chi2, double mu) {
  if (chi2 <= mu / (mu + 1) * kRightChi2) return 1;
  if (chi2 >= (mu + 1) / mu * kRightChi2) return 0;
  return std::sqrt(kRightChi2 * mu * (mu + 1) / chi2) - mu;
}

// The weights of the edges that may be wrong, for a loss that is less convex with each call.
class Graduation {
 public:
  explicit Graduation(const PoseGraph& graph) : graph_(graph) {}

  // Updates the weights; returns false when they are final.
  bool Update(const std::vector<double>& chi2, std::vector<double>& weights) {
    double largest = 0;
    for (std::size_t e = 0; e < chi2.size(); ++e) {
      if (graph_.edges[e].may_be_wrong) largest = std::max(largest, chi2[e]);
    }
    if (mu_ == 0) {
      if (largest <= kRightChi2) return false;
      mu_ = kRightChi2 / (2 * largest - kRightChi2);
    } else {
      mu_ *= kGrowth;
    }
    bool binary = true;
    for (std::size_t e = 0; e < chi2.size(); ++e) {
      if (!graph_.edges[e].may_be_wrong) continue;
      weights[e] = Weight(chi2[e], mu_);
      binary = binary && (weights[e] == 0 || weights[e] == 1);
    }
    const bool done = binary && settled_;
    settled_ = binary;
    return !done;
  }

 private:
  static constexpr double kGrowth = 2;

  const PoseGraph& graph_;
  double mu_ = 0;         // 0 before the first call
  bool settled_ = false;  // all weights were 0 or 1 after the last call
};

template <int kSize>
PoseGraphResult Solve(const PoseGraph& graph) {
  PoseGraphResult result;
  result.poses = graph.poses;
  result.weights.assign(graph.edges.size(), 1);
  System<kSize> system(graph);
  Graduation graduation(graph);
  for (int i = 0; i < kMaxSteps; ++i) {
    const auto step = system.Step(result.weights, result.poses);
    if (!step) break;
    if (*step > kStepTolerance) continue;
    result.converged = !graduation.Update(Chi2(graph, result.poses), result.weights);
    if (result.converged) break;
  }
  result.chi2 = Chi2(graph, result.poses);
  return result;
}

}  // namespace

Vector7d PoseGraphResidual(const PoseGraphEdge& edge,
                           const Similarity3& to,
                           const Similarity3& from) {
  return LogSim3(to * Inverse(from) * Inverse(edge.to_from));
}

PoseGraphResult SolvePoseGraph(const PoseGraph& graph) {
  PLUMBLINE_CHECK(graph.fixed.size() == graph.poses.size(), "a flag for each pose");
  return graph.motion == PoseGraphMotion::kRigid ? Solve<6>(graph) : Solve<7>(graph);
}

}  // namespace plumbline
