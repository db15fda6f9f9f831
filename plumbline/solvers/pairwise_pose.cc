// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/pairwise_pose.h"

#include "plumbline/base/chi2.h"
#include "plumbline/geometry/eigenpairs.h"
#include "plumbline/geometry/epipolar.h"
#include "plumbline/solvers/epipolar_cost.h"
#include "plumbline/solvers/essential.h"
#include "plumbline/solvers/ransac.h"
#include "plumbline/solvers/relative_pose.h"
#include "plumbline/solvers/relative_pose_problems.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace plumbline {
namespace {

constexpr int kMostSamples = 500;

Eigen::Vector3d PlaneNormal(const Eigen::Quaterniond& b_from_a, const RayMatch& match) {
  return (b_from_a * match.a.homogeneous()).cross(match.b.homogeneous());
}

// The eight-point algorithm without local optimization.
class PlainEightPointProblem : public EightPointProblem {
 public:
  using EightPointProblem::EightPointProblem;
  Model Improve(const Model& E) const { return E; }
};

// The direction of the translation with the rotation known, from samples of two.
class TwoPointProblem {
 public:
  using Model = Eigen::Vector3d;
  static constexpr std::size_t kSampleSize = 2;

  TwoPointProblem(std::span<const RayMatch> matches, const Eigen::Quaterniond& b_from_a)
      : matches_(matches), b_from_a_(b_from_a), cost_(matches) {}

  std::size_t size() const { return matches_.size(); }
  std::vector<Model> Solve(const std::array<std::size_t, kSampleSize>& sample) const {
    const std::array<RayMatch, 2> pair = {matches_[sample[0]], matches_[sample[1]]};
    const auto t = TranslationFromTwoPoints(b_from_a_, pair);
    return t ? std::vector<Model>{*t} : std::vector<Model>{};
  }
  double Cost(const Model& t, double limit) const {
    return cost_.Truncated(EssentialMatrix({b_from_a_, t}), kChi2OneDof95, limit);
  }
  double InlierRatio(const Model& t) const {
    return cost_.CountBelow(EssentialMatrix({b_from_a_, t}), kChi2OneDof95) /
           static_cast<double>(matches_.size());
  }
  Model Improve(const Model& t) const { return t; }
  bool Same(const Model& a, const Model& b) const { return a.cross(b).norm() < 1e-3; }

 private:
  std::span<const RayMatch> matches_;
  Eigen::Quaterniond b_from_a_;
  EpipolarCost cost_;
};

std::vector<RayMatch> Near(const Eigen::Matrix3d& essential, std::span<const RayMatch> matches) {
  std::vector<RayMatch> near;
  for (const RayMatch& match : matches) {
    if (IsNearEpipolarLines(essential, match)) near.push_back(match);
  }
  return near;
}

long CountInFront(const Rigid3& pose, std::span<const RayMatch> matches) {
  return std::count_if(matches.begin(), matches.end(), [&](const RayMatch& match) {
    return IsInFront(pose, match);
  });
}

std::optional<Eigen::Quaterniond> RotationFromEightPoints(std::span<const RayMatch> matches,
                                                          Rng& rng) {
  const PlainEightPointProblem problem(matches);
  const auto found = Ransac<PlainEightPointProblem>(problem, kMostSamples, 1).Run({}, rng);
  if (found.empty()) return std::nullopt;
  std::vector<RayMatch> inliers = Near(found.front().model, matches);
  const Eigen::Matrix3d E = EssentialFromEightPoints(inliers).value_or(found.front().model);
  const auto poses = PosesFromEssential(E);
  const auto best = std::max_element(poses.begin(), poses.end(), [&](const auto& a, const auto& b) {
    return CountInFront(a, inliers) < CountInFront(b, inliers);
  });
  return best->rotation;
}

// Least squares on t . (R x_a x x_b) over the matches that fit the direction `start`.
Eigen::Vector3d TranslationFromInliers(std::span<const RayMatch> matches,
                                       const Eigen::Quaterniond& b_from_a,
                                       const Eigen::Vector3d& start) {
  const Eigen::Matrix3d E = EssentialMatrix({b_from_a, start});
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  int inliers = 0;
  for (const RayMatch& match : matches) {
    if (!IsNearEpipolarLines(E, match)) continue;
    const Eigen::Vector3d row = PlaneNormal(b_from_a, match);
    normal += row * row.transpose();
    ++inliers;
  }
  if (inliers < 2) return start;
  const Eigen::Vector3d t = EigenpairsOf<3>(normal).vectors.col(0);
  return t.dot(start) < 0 ? Eigen::Vector3d(-t) : t;
}

}  // namespace

std::optional<Eigen::Vector3d> TranslationFromTwoPoints(const Eigen::Quaterniond& b_from_a,
                                                        std::span<const RayMatch, 2> matches) {
  const Eigen::Vector3d first = PlaneNormal(b_from_a, matches[0]);
  const Eigen::Vector3d second = PlaneNormal(b_from_a, matches[1]);
  const Eigen::Vector3d t = first.cross(second);
  if (!(t.norm() > 1e-9 * first.norm() * second.norm())) return std::nullopt;
  return t.normalized();
}

bool IsNearEpipolarLines(const Eigen::Matrix3d& essential, const RayMatch& match) {
  const Eigen::Vector3d in_b = essential * match.a.homogeneous();
  const Eigen::Vector3d in_a = essential.transpose() * match.b.homogeneous();
  const double error = match.b.homogeneous().dot(in_b);
  const auto is_near = [&](const Eigen::Vector3d& line, double sigma) {
    return error * error < kChi2OneDof95 * sigma * sigma * line.head<2>().squaredNorm();
  };
  return is_near(in_b, match.sigma_b) && is_near(in_a, match.sigma_a);
}

std::optional<PairwisePose> EstimatePairwisePose(std::span<const RayMatch> matches, Rng& rng) {
  if (matches.size() < EightPointProblem::kSampleSize) return std::nullopt;
  const auto rotation = RotationFromEightPoints(matches, rng);
  if (!rotation) return std::nullopt;
  const TwoPointProblem problem(matches, *rotation);
  const auto found = Ransac<TwoPointProblem>(problem, kMostSamples, 1).Run({}, rng);
  if (found.empty()) return std::nullopt;
  PairwisePose pose;
  pose.b_from_a = {*rotation, TranslationFromInliers(matches, *rotation, found.front().model)};
  Rigid3 opposite = pose.b_from_a;
  opposite.translation *= -1;
  const Eigen::Matrix3d E = EssentialMatrix(pose.b_from_a);
  const std::vector<RayMatch> inliers = Near(E, matches);
  if (CountInFront(opposite, inliers) > CountInFront(pose.b_from_a, inliers)) {
    pose.b_from_a = opposite;
  }
  for (const RayMatch& match : matches) pose.is_inlier.push_back(IsNearEpipolarLines(E, match));
  return pose;
}

}  // namespace plumbline
