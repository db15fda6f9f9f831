// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/relative_pose.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/random.h"
#include "plumbline/base/statistics.h"
#include "plumbline/base/units.h"
#include "plumbline/geometry/epipolar.h"
#include "plumbline/geometry/symmetric_matrix.h"
#include "plumbline/solvers/epipolar_cost.h"
#include "plumbline/solvers/essential.h"
#include "plumbline/solvers/homography.h"
#include "plumbline/solvers/pose_refinement.h"
#include "plumbline/solvers/ransac.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace plumbline {
namespace {

// Two-view problems for RANSAC (ransac.h). They refer to the matches, which must outlive them.

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

// Essential matrices, Frobenius norm 1.
class EssentialProblem {
 public:
  using Model = Eigen::Matrix3d;

  explicit EssentialProblem(std::span<const RayMatch> matches) : matches_(matches), cost_(matches) {
    const std::size_t step = std::max<std::size_t>(1, matches.size() / kEnoughForFirst);
    for (std::size_t i = 0; i < matches.size(); i += step) thinned_.push_back(matches[i]);
  }

  std::size_t size() const { return matches_.size(); }
  double Cost(const Model& E, double limit) const {
    return cost_.Truncated(E, kChi2OneDof95, limit);
  }
  double InlierRatio(const Model& E) const {
    return Ratio(cost_.CountBelow(E, kChi2OneDof95), size());
  }
  // Improves E by a few steps of RefinePose under a wide loss.
  Model Improve(const Model& E) const {
    // All four poses have the same cost.
    const Rigid3 pose = PosesFromEssential(E).front();
    const Rigid3 near = RefinePose(thinned_, pose, kFirstImprovement).b_from_a;
    return EssentialMatrix(RefinePose(matches_, near, kSecondImprovement).b_from_a).normalized();
  }
  // Returns true if both are equal up to sign.
  bool Same(const Model& E, const Model& F) const {
    return std::min((E - F).squaredNorm(), (E + F).squaredNorm()) < kSameEssential * kSameEssential;
  }

 protected:
  std::span<const RayMatch> matches_;

 private:
  EpipolarCost cost_;
  std::vector<RayMatch> thinned_;  // subset of the matches, enough to come near the solution
};

class FivePointProblem : public EssentialProblem {
 public:
  static constexpr std::size_t kSampleSize = 5;
  using EssentialProblem::EssentialProblem;
  std::vector<Model> Solve(const std::array<std::size_t, kSampleSize>& sample) const {
    return EssentialFromFivePoints(Pick(matches_, sample));
  }
};

class EightPointProblem : public EssentialProblem {
 public:
  static constexpr std::size_t kSampleSize = 8;
  using EssentialProblem::EssentialProblem;
  std::vector<Model> Solve(const std::array<std::size_t, kSampleSize>& sample) const {
    const auto E = EssentialFromEightPoints(Pick(matches_, sample));
    return E ? std::vector<Model>{*E} : std::vector<Model>{};
  }
};

class HomographyProblem {
 public:
  using Model = Eigen::Matrix3d;
  static constexpr std::size_t kSampleSize = 4;

  explicit HomographyProblem(std::span<const RayMatch> matches) : matches_(matches) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const RayMatch& match : matches) sum += match.a.homogeneous();
    if (!matches.empty()) mean_ray_ = sum.normalized();
  }

  std::size_t size() const { return matches_.size(); }
  std::vector<Model> Solve(const std::array<std::size_t, kSampleSize>& sample) const {
    const auto H = HomographyFromFourPoints(Pick(matches_, sample));
    return H ? std::vector<Model>{*H} : std::vector<Model>{};
  }
  double Cost(const Model& H, double limit) const {
    double sum = 0;
    for (const RayMatch& match : matches_) {
      sum += std::min(SquaredTransferError(H, match), kChi2TwoDof95);
      if (sum > limit) break;
    }
    return sum;
  }
  double InlierRatio(const Model& H) const {
    const auto count = std::count_if(matches_.begin(), matches_.end(), [&](const RayMatch& m) {
      return SquaredTransferError(H, m) < kChi2TwoDof95;
    });
    return Ratio(count, size());
  }
  // Improves H by least squares on the inliers.
  Model Improve(const Model& H) const {
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
  bool Same(const Model&, const Model&) const { return true; }  // only the best model is kept

  Eigen::Vector3d MeanRay() const { return mean_ray_; }  // mean ray of camera a

 private:
  std::span<const RayMatch> matches_;
  Eigen::Vector3d mean_ray_ = Eigen::Vector3d::UnitZ();
};

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
