// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/relative_pose.h"

#include "plumbline/base/chi2.h"
#include "plumbline/base/elementary.h"
#include "plumbline/base/random.h"
#include "plumbline/base/units.h"
#include "plumbline/geometry/epipolar.h"
#include "plumbline/solvers/epipolar_cost.h"
#include "plumbline/solvers/pose_refinement.h"
#include "plumbline/solvers/ransac.h"
#include "plumbline/solvers/relative_pose_problems.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace plumbline {
namespace {

constexpr double kSameRotation = 0.3 * kDegree;
constexpr double kSameDirection = 3 * kDegree;
// A hypothesis with fewer inliers, or fewer points in front, than this part of the best one's is
// dropped.
constexpr double kRivalPart = 0.7;
// RANSAC hands on models of up to this many times the least cost beside its best one, since
// refinement brings rivals together.
constexpr double kRivalCost = 1.25;
// A plane with fewer than half of the inliers does not decide, so that samples for half of them are
// enough.
constexpr int kMaxHomographies = 110;
constexpr double kPlanePart = 0.45;

int CountInFront(std::span<const RayMatch> matches,
                 const std::vector<bool>& is_inlier,
                 const Rigid3& pose) {
  int count = 0;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (is_inlier[i] && IsInFront(pose, matches[i])) ++count;
  }
  return count;
}

RelativePoseHypothesis Judge(std::span<const RayMatch> matches, const RefinedPose& refined) {
  RelativePoseHypothesis h;
  h.b_from_a = refined.b_from_a;
  h.covariance = refined.covariance;
  const Eigen::Matrix3d E = EssentialMatrix(h.b_from_a);
  h.is_inlier.resize(matches.size());
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const double chi2 = SampsonChi2(E, matches[i]);
    h.is_inlier[i] = chi2 < kChi2OneDof95;
    h.inliers += h.is_inlier[i] ? 1 : 0;
    h.cost += std::min(chi2, kChi2OneDof95);
  }
  h.in_front = CountInFront(matches, h.is_inlier, h.b_from_a);
  return h;
}

// Returns the judged pose with the same rotation and the opposite translation.
RelativePoseHypothesis Opposite(std::span<const RayMatch> matches, RelativePoseHypothesis h) {
  // BasisAcross(-t) is BasisAcross(t) with the first column negated, so that the same change of
  // pose has the second coordinate negated.
  h.b_from_a.translation = -h.b_from_a.translation;
  h.covariance.row(4) *= -1;
  h.covariance.col(4) *= -1;
  h.in_front = CountInFront(matches, h.is_inlier, h.b_from_a);
  return h;
}

bool AreSame(const Rigid3& a, const Rigid3& b) {
  return AngularDistance(a.rotation, b.rotation) < kSameRotation &&
         a.translation.dot(b.translation) > math::Cos(kSameDirection);
}

class HypothesisList {
 public:
  HypothesisList(std::span<const RayMatch> matches, Rng& rng) : matches_(matches), rng_(rng) {}

  // Refines one pose of each pair that differs in the sign of the translation.
  void Add(RelativePoseModel model, const Rigid3& start) {
    if (IsRefinedAlready(start)) return;
    RelativePoseHypothesis h = Judge(matches_, PolishPose(matches_, start, rng_));
    h.model = model;
    RelativePoseHypothesis opposite = Opposite(matches_, h);
    list_.push_back(std::move(h));
    list_.push_back(std::move(opposite));
  }

  std::vector<RelativePoseHypothesis> Take() {
    std::stable_sort(
        list_.begin(), list_.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
    int most_inliers = 0;
    int most_in_front = 0;
    for (const RelativePoseHypothesis& h : list_) {
      most_inliers = std::max(most_inliers, h.inliers);
      most_in_front = std::max(most_in_front, h.in_front);
    }
    std::vector<RelativePoseHypothesis> kept;
    for (RelativePoseHypothesis& h : list_) {
      if (h.inliers < kRivalPart * most_inliers || h.in_front < kRivalPart * most_in_front)
        continue;
      const bool known = std::any_of(kept.begin(), kept.end(), [&](const auto& other) {
        return AreSame(other.b_from_a, h.b_from_a);
      });
      if (!known) kept.push_back(std::move(h));
    }
    return kept;
  }

 private:
  bool IsRefinedAlready(const Rigid3& start) const {
    return std::any_of(list_.begin(), list_.end(), [&](const auto& h) {
      return AngularDistance(h.b_from_a.rotation, start.rotation) < 0.1 * kSameRotation &&
             h.b_from_a.translation.dot(start.translation) > math::Cos(0.1 * kSameDirection);
    });
  }

  std::span<const RayMatch> matches_;
  Rng& rng_;
  std::vector<RelativePoseHypothesis> list_;
};

// Returns the two rotations of an essential matrix, each with one of its translations.
std::array<Rigid3, 2> RotationsOf(const Eigen::Matrix3d& essential) {
  const std::array<Rigid3, 4> poses = PosesFromEssential(essential);
  return {poses[0], poses[2]};
}

template <class Problem>
void AddEssentials(std::span<const RayMatch> matches,
                   const RelativePoseOptions& options,
                   std::span<const Rigid3> guesses,
                   Rng& rng,
                   HypothesisList& list) {
  std::vector<Eigen::Matrix3d> models;
  for (const Rigid3& guess : guesses) models.push_back(EssentialMatrix(guess).normalized());
  const Problem problem(matches);
  for (const auto& scored :
       Ransac<Problem>(problem, options.max_iterations, kRivalCost).Run(models, rng)) {
    // Refinement keeps the rotation, and the epipolar distance is the same for both rotations. Only
    // the rotation with points in front is worth refining.
    const auto poses = RotationsOf(scored.model);
    const auto most_in_front = [&](const Rigid3& pose) {
      const std::vector<bool> all(matches.size(), true);
      const Rigid3 opposite{pose.rotation, -pose.translation};
      return std::max(CountInFront(matches, all, pose), CountInFront(matches, all, opposite));
    };
    const int first = most_in_front(poses[0]);
    const int second = most_in_front(poses[1]);
    const int enough = static_cast<int>(kRivalPart * std::max(first, second));
    if (first >= enough) list.Add(RelativePoseModel::kEssential, poses[0]);
    if (second >= enough) list.Add(RelativePoseModel::kEssential, poses[1]);
  }
}

// Adds both motions of the plane with most matches, if it has enough of them.
void AddHomographies(std::span<const RayMatch> matches,
                     const RelativePoseOptions& options,
                     Rng& rng,
                     HypothesisList& list) {
  const int most_samples = std::min(options.max_iterations, kMaxHomographies);
  const HomographyProblem problem(matches);
  const auto best = Ransac<HomographyProblem>(problem, most_samples, 1).Run({}, rng);
  if (best.empty() || problem.InlierRatio(best.front().model) < kPlanePart) return;
  for (const PlanarMotion& motion : MotionsFromHomography(best.front().model)) {
    const double length = motion.b_from_a.translation.norm();
    // Motions come in pairs with opposite normals; only the one whose plane is in front counts.
    if (!(length > 0) || motion.normal.dot(problem.MeanRay()) < 0) continue;
    list.Add(RelativePoseModel::kHomography,
             {motion.b_from_a.rotation, motion.b_from_a.translation / length});
  }
}

}  // namespace

bool IsInFront(const Rigid3& b_from_a, const RayMatch& match) {
  const Eigen::Vector3d q = b_from_a.rotation * match.a.homogeneous();
  const Eigen::Vector3d b = match.b.homogeneous();
  // Crossing depth_b b = depth_a q + t with b and with q gives the signs of the depths.
  const Eigen::Vector3d normal = b.cross(q);
  return b.cross(b_from_a.translation).dot(normal) < 0 &&
         q.cross(b_from_a.translation).dot(normal) < 0;
}

std::vector<RelativePoseHypothesis> EstimateRelativePoses(std::span<const RayMatch> matches,
                                                          const RelativePoseOptions& options,
                                                          Rng& rng,
                                                          std::span<const Rigid3> guesses) {
  HypothesisList list(matches, rng);
  if (options.method == RelativePoseMethod::kEightPoint) {
    AddEssentials<EightPointProblem>(matches, options, guesses, rng, list);
  } else {
    AddEssentials<FivePointProblem>(matches, options, guesses, rng, list);
    AddHomographies(matches, options, rng, list);
  }
  return list.Take();
}

}  // namespace plumbline
