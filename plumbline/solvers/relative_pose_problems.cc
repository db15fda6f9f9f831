// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/relative_pose_problems.h"

#include "plumbline/base/chi2.h"
#include "plumbline/geometry/epipolar.h"
#include "plumbline/solvers/pose_refinement.h"

#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

// Essential matrices of norm 1 that differ by less than this lead to the same pose when refined.
constexpr double kSameEssential = 0.05;
// The model of a sample is off by many times the noise, and not all of its best inliers are
// inliers.
constexpr PoseRefinementOptions kFirstImprovement{
    .max_iterations = 3, .loss_scale = 15, .covariance = false};
constexpr PoseRefinementOptions kSecondImprovement{.max_iterations = 2, .covariance = false};
constexpr std::size_t kEnoughForFirst = 100;  // matches that are enough for the first improvement

template <std::size_t kSize>
std::array<RayMatch, kSize> Pick(std::span<const RayMatch> matches,
                                 const std::array<std::size_t, kSize>& sample) {
  std::array<RayMatch, kSize> picked;
  for (std::size_t i = 0; i < kSize; ++i) picked[i] = matches[sample[i]];
  return picked;
}

double Ratio(std::ptrdiff_t part, std::size_t all) {
  return static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(all, 1));
}

}  // namespace

EssentialProblem::EssentialProblem(std::span<const RayMatch> matches)
    : matches_(matches), cost_(matches) {
  const std::size_t step = std::max<std::size_t>(1, matches.size() / kEnoughForFirst);
  for (std::size_t i = 0; i < matches.size(); i += step) thinned_.push_back(matches[i]);
}

double EssentialProblem::InlierRatio(const Model& E) const {
  return Ratio(cost_.CountBelow(E, kChi2OneDof95), size());
}

EssentialProblem::Model EssentialProblem::Improve(const Model& E) const {
  // All four poses have the same cost.
  const Rigid3 pose = PosesFromEssential(E).front();
  const Rigid3 near = RefinePose(thinned_, pose, kFirstImprovement).b_from_a;
  return EssentialMatrix(RefinePose(matches_, near, kSecondImprovement).b_from_a).normalized();
}

bool EssentialProblem::Same(const Model& E, const Model& F) const {
  return std::min((E - F).squaredNorm(), (E + F).squaredNorm()) < kSameEssential * kSameEssential;
}

std::vector<Eigen::Matrix3d> FivePointProblem::Solve(
    const std::array<std::size_t, kSampleSize>& sample) const {
  return EssentialFromFivePoints(Pick(matches_, sample));
}

std::vector<Eigen::Matrix3d> EightPointProblem::Solve(
    const std::array<std::size_t, kSampleSize>& sample) const {
  const auto E = EssentialFromEightPoints(Pick(matches_, sample));
  return E ? std::vector<Model>{*E} : std::vector<Model>{};
}

HomographyProblem::HomographyProblem(std::span<const RayMatch> matches) : matches_(matches) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const RayMatch& match : matches) sum += match.a.homogeneous();
  if (!matches.empty()) mean_ray_ = sum.normalized();
}

std::vector<Eigen::Matrix3d> HomographyProblem::Solve(
    const std::array<std::size_t, kSampleSize>& sample) const {
  const auto H = HomographyFromFourPoints(Pick(matches_, sample));
  return H ? std::vector<Model>{*H} : std::vector<Model>{};
}

double HomographyProblem::Cost(const Model& H, double limit) const {
  double sum = 0;
  for (const RayMatch& match : matches_) {
    sum += std::min(SquaredTransferError(H, match), kChi2TwoDof95);
    if (sum > limit) break;
  }
  return sum;
}

double HomographyProblem::InlierRatio(const Model& H) const {
  const auto count = std::count_if(matches_.begin(), matches_.end(), [&](const RayMatch& m) {
    return SquaredTransferError(H, m) < kChi2TwoDof95;
  });
  return Ratio(count, size());
}

HomographyProblem::Model HomographyProblem::Improve(const Model& H) const {
  Model improved = H;
  for (int i = 0; i < 2; ++i) {
    std::vector<RayMatch> inliers;
    for (const RayMatch& match : matches_) {
      if (SquaredTransferError(improved, match) < 2 * kChi2TwoDof95) inliers.push_back(match);
    }
    const auto fitted = HomographyFromPoints(inliers, &improved);
    if (!fitted) break;
    improved = *fitted;
  }
  return improved;
}

}  // namespace plumbline
