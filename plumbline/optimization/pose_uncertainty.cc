// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/pose_uncertainty.h"

#include "plumbline/base/statistics.h"
#include "plumbline/geometry/covariance.h"
#include "plumbline/geometry/symmetric_matrix.h"
#include "plumbline/geometry/trimming.h"
#include "plumbline/optimization/residuals.h"

#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

namespace plumbline {
namespace {

// The sums over the observations of one pose.
struct Sums {
  bool wanted = true;
  Matrix6d information = Matrix6d::Zero();
  std::vector<double> depths;
};

void AddPoints(const BaProblem& problem, const BaResult& state, std::vector<Sums>& sums) {
  for (std::size_t k = 0; k < problem.point_observations.size(); ++k) {
    const auto& o = problem.point_observations[k];
    Sums& sum = sums[static_cast<std::size_t>(o.pose)];
    if (!state.point_inliers[k] || !sum.wanted) continue;
    const Eigen::Vector3d p = state.poses[static_cast<std::size_t>(o.pose)] *
                              state.points[static_cast<std::size_t>(o.point)];
    PointLinearization at;
    if (!LinearizePoint(problem.camera, MakePointTerm(o.measurement), p, at)) continue;
    const Eigen::Matrix3d J_cam = PointJacobian(at);
    Eigen::Matrix<double, 3, 6> J;  // the last row is zero without disparity
    J << -J_cam * Skew(p), J_cam;
    sum.information.noalias() += J.transpose() * J;
    sum.depths.push_back(p.z());
  }
}

void AddLines(const BaProblem& problem, const BaResult& state, std::vector<Sums>& sums) {
  std::optional<PreparedLine> prepared;  // the line of the observation before
  int line = -1;
  for (std::size_t k = 0; k < problem.line_observations.size(); ++k) {
    const auto& o = problem.line_observations[k];
    Sums& sum = sums[static_cast<std::size_t>(o.pose)];
    if (!state.line_inliers[k] || !sum.wanted) continue;
    const OrthonormalLine& orthonormal = state.lines[static_cast<std::size_t>(o.line)];
    if (o.line != line) prepared.emplace(orthonormal);
    line = o.line;
    const Rigid3& cam_from_world = state.poses[static_cast<std::size_t>(o.pose)];
    const auto residual = EvaluateLine(problem.camera, cam_from_world, *prepared, o.measurement);
    if (!residual) continue;
    sum.information.noalias() += residual->J_pose.transpose() * residual->J_pose;
    if (o.measurement.camera != 0) continue;
    const PluckerLine plucker = ToPlucker(orthonormal);
    const auto seen = TrimToSegment(problem.camera, cam_from_world, plucker, o.measurement.segment);
    if (!seen) continue;
    const Segment3 part = SegmentOf(plucker, *seen);
    sum.depths.push_back((cam_from_world * part.Midpoint()).z());
  }
}

std::vector<PoseUncertainty> SigmasOf(const BaProblem& problem,
                                      const BaResult& state,
                                      std::vector<Sums> sums) {
  AddPoints(problem, state, sums);
  AddLines(problem, state, sums);
  std::vector<PoseUncertainty> sigmas;
  sigmas.reserve(sums.size());
  for (Sums& s : sums) {
    sigmas.push_back(SigmaOfPose(s.information, UpperMedian(std::span<double>(s.depths))));
  }
  return sigmas;
}

// Returns the deviations of all poses; those of fixed poses are not computed.
std::vector<PoseUncertainty> SigmasOfFreePoses(const BaProblem& problem, const BaResult& state) {
  std::vector<Sums> sums(problem.poses.size());
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i].wanted = !problem.poses[i].fixed;
  return SigmasOf(problem, state, std::move(sums));
}

}  // namespace

PoseUncertainty SigmaOfPose(const Matrix6d& information, double scene_depth) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (!(scene_depth > 0)) return {kInfinity, kInfinity, 0};
  Vector6d unit = Vector6d::Ones();
  unit.tail<3>().setConstant(scene_depth);
  const Matrix6d scaled = unit.asDiagonal() * information * unit.asDiagonal();
  const auto [values, vectors] = EigenpairsOf<6>(scaled);
  if (!(values(0) > 1e-12 * values(5))) return {kInfinity, kInfinity, scene_depth};
  const Matrix6d covariance = vectors * values.cwiseInverse().asDiagonal() * vectors.transpose();
  return {LargestSigma(covariance.topLeftCorner<3, 3>()),
          LargestSigma(covariance.bottomRightCorner<3, 3>()),
          scene_depth};
}

std::vector<PoseUncertainty> SigmasOfPoses(const BaProblem& problem, const BaResult& state) {
  return SigmasOf(problem, state, std::vector<Sums>(problem.poses.size()));
}

bool FixUnconstrainedPoses(const std::vector<PoseUncertainty>& sigmas,
                           double limit,
                           BaProblem& problem) {
  bool any = false;
  for (std::size_t i = 0; i < sigmas.size(); ++i) {
    if (problem.poses[i].fixed || sigmas[i].AtMost(limit)) continue;
    problem.poses[i].fixed = true;
    any = true;
  }
  return any;
}

bool FixInconsistentPoses(const BaResult& solution,
                          const std::vector<PoseUncertainty>& sigmas,
                          const PoseLimits& limits,
                          BaProblem& problem) {
  bool any = false;
  std::optional<std::size_t> last;
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    if (!problem.poses[i].follows) last.reset();
    if (!sigmas[i].AtMost(limits.sigma)) continue;
    const std::optional<std::size_t> before = std::exchange(last, i);
    if (!before) continue;
    auto& a = problem.poses[*before];
    auto& b = problem.poses[i];
    if (a.fixed && b.fixed) continue;
    const Rigid3 motion = solution.poses[i] * Inverse(solution.poses[*before]);
    const Vector6d change = LogSe3(motion * Inverse(b.cam_from_world * Inverse(a.cam_from_world)));
    if (change.head<3>().norm() <= limits.change &&
        change.tail<3>().norm() <= limits.change * sigmas[i].scene_depth) {
      continue;
    }
    a.fixed = b.fixed = true;
    any = true;
  }
  return any;
}

namespace {

bool Failed(const BaResult& result) {
  return result.termination == BaTermination::kNotFinite ||
         result.termination == BaTermination::kStopped;
}

struct Solution {
  BaResult result;
  std::vector<PoseUncertainty> sigmas;  // uncertainties of `result`; empty if the solution failed
};

// Solves with unconstrained poses fixed: those unconstrained before the solution, or by the
// observations that it rejects; they are marked as fixed in the problem.
Solution SolveHoldingLoosePoses(BaProblem& problem,
                                const LocalBaOptions& options,
                                BaSolver solver,
                                double limit,
                                const StopCheck& stop) {
  FixUnconstrainedPoses(SigmasOfFreePoses(problem, InitialState(problem)), limit, problem);
  const auto solve = [&] {
    BaResult result = solver(problem, options, stop);
    std::vector<PoseUncertainty> sigmas;
    if (!Failed(result)) sigmas = SigmasOfPoses(problem, result);
    return Solution{std::move(result), std::move(sigmas)};
  };
  Solution solution = solve();
  // The rejection of observations may have made poses loose that the observations fixed before.
  if (!FixUnconstrainedPoses(solution.sigmas, limit, problem)) return solution;
  return solve();
}

}  // namespace

std::optional<BaResult> SolveWithPoseLimits(BaProblem& problem,
                                            const LocalBaOptions& options,
                                            BaSolver solve,
                                            const PoseLimits& limits,
                                            const std::function<void(BaResult&)>& normalize,
                                            const StopCheck& stop) {
  constexpr int kAttempts = 4;
  for (int attempt = 1;; ++attempt) {
    auto [result, sigmas] = SolveHoldingLoosePoses(problem, options, solve, limits.sigma, stop);
    if (Failed(result)) return std::nullopt;
    if (normalize) {
      normalize(result);
      sigmas = SigmasOfPoses(problem, result);
    }
    if (!FixInconsistentPoses(result, sigmas, limits, problem)) return std::move(result);
    if (attempt + 1 < kAttempts) continue;
    for (auto& pose : problem.poses) pose.fixed = true;
  }
}

}  // namespace plumbline
