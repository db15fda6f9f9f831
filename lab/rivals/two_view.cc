// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/rivals/two_view.h"

#include "lab/rivals/start_steps.h"
#include "plumbline/base/ids.h"
#include "plumbline/base/statistics.h"
#include "plumbline/base/units.h"
#include "plumbline/solvers/epipolar_cost.h"
#include "plumbline/solvers/essential.h"
#include "plumbline/solvers/homography.h"
#include "plumbline/solvers/ransac.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>

namespace plumbline {
namespace {

// Values of the paper (section IV), or of its published system if the paper gives none.
constexpr std::size_t kMinFeatures = 100;
constexpr std::size_t kMinMatches = 100;
constexpr std::size_t kMinPoints = 50;
constexpr double kHomographyShare = 0.45;
constexpr double kRivalPartOfFundamental = 0.7;
constexpr double kRivalPartOfHomography = 0.75;
constexpr double kMinGoodPart = 0.9;  // share of the inliers of the model
constexpr double kMinParallaxDeg = 1;
constexpr int kSamples = 200;
constexpr double kMaxReprojectionChi2 = 8;  // of the best point, both images: two pixels in each

double Gain(double chi2, double limit) { return chi2 < limit ? kChi2TwoDof95 - chi2 : 0; }

// Returns the squared distance of a point from an image line, over the variance of a coordinate.
double LineChi2(const Eigen::Vector3d& line, const Eigen::Vector2d& point, double sigma) {
  const double distance = line.dot(point.homogeneous());
  return distance * distance / (line.head<2>().squaredNorm() * sigma * sigma + 1e-300);
}

double PointChi2(const Eigen::Vector3d& mapped, const Eigen::Vector2d& point, double sigma) {
  if (mapped.z() == 0) return 2 * kChi2TwoDof95;
  return (mapped.head<2>() / mapped.z() - point).squaredNorm() / (sigma * sigma);
}

// The two distances of a match, one in each image, over their deviations, squared.
using BothChi2 = std::array<double, 2>;

BothChi2 EpipolarChi2(const Eigen::Matrix3d& F, const RayMatch& m) {
  return {LineChi2(F * m.a.homogeneous(), m.b, m.sigma_b),
          LineChi2(F.transpose() * m.b.homogeneous(), m.a, m.sigma_a)};
}

BothChi2 TransferChi2(const Eigen::Matrix3d& H, const Eigen::Matrix3d& inverse, const RayMatch& m) {
  return {PointChi2(H * m.a.homogeneous(), m.b, m.sigma_b),
          PointChi2(inverse * m.b.homogeneous(), m.a, m.sigma_a)};
}

std::vector<RayMatch> Inliers(const Eigen::Matrix3d& model,
                              TwoViewModel kind,
                              std::span<const RayMatch> matches) {
  const bool epipolar = kind == TwoViewModel::kFundamental;
  const double limit = epipolar ? kChi2OneDof95 : kChi2TwoDof95;
  const Eigen::Matrix3d inverse = epipolar ? model : model.inverse();
  std::vector<RayMatch> inliers;
  for (const RayMatch& m : matches) {
    const auto [in_b, in_a] = epipolar ? EpipolarChi2(model, m) : TransferChi2(model, inverse, m);
    if (in_b < limit && in_a < limit) inliers.push_back(m);
  }
  return inliers;
}

struct ScoredMatrix {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  double score = 0;

  void TakeBetter(const Eigen::Matrix3d& other, double of_other) {
    if (of_other > score) *this = {other, of_other};
  }
};

struct BothModels {
  ScoredMatrix fundamental, homography;
};

// The best fundamental matrix and the best homography of random sets of eight matches.
BothModels BestModels(std::span<const RayMatch> matches, Rng& rng) {
  BothModels best;
  for (int k = 0; k < kSamples; ++k) {
    const auto sample = DrawSample<8>(matches.size(), rng);
    std::array<RayMatch, 8> picked;
    for (std::size_t i = 0; i < sample.size(); ++i) picked[i] = matches[sample[i]];
    if (const auto F = FundamentalFromEightPoints(picked)) {
      best.fundamental.TakeBetter(*F, EpipolarScore(*F, matches));
    }
    if (const auto H = HomographyFromPoints(picked)) {
      best.homography.TakeBetter(*H, TransferScore(*H, matches));
    }
  }
  return best;
}

std::vector<Rigid3> MotionsOf(const Eigen::Matrix3d& model, TwoViewModel kind) {
  std::vector<Rigid3> motions;
  if (kind == TwoViewModel::kFundamental) {  // of rays, so that it stands for an essential matrix
    const auto poses = PosesFromEssential(model);
    motions.assign(poses.begin(), poses.end());
    return motions;
  }
  for (const PlanarMotion& motion : MotionsFromHomography(model)) {
    const double length = motion.b_from_a.translation.norm();
    if (length > 0) {
      motions.push_back({motion.b_from_a.rotation, motion.b_from_a.translation / length});
    }
  }
  return motions;
}

bool IsGood(const Rigid3& pose, const Eigen::Matrix3d& essential, const RayMatch& match) {
  return SampsonChi2(essential, match) < kMaxReprojectionChi2 && IsInFront(pose, match);
}

struct MotionVote {
  Rigid3 pose;
  std::size_t good = 0;
};

// Returns all motions, the one with most good points first.
std::vector<MotionVote> Vote(std::span<const Rigid3> motions, std::span<const RayMatch> inliers) {
  std::vector<MotionVote> votes;
  for (const Rigid3& pose : motions) {
    const Eigen::Matrix3d E = Skew(pose.translation) * pose.rotation.toRotationMatrix();
    const auto good = std::count_if(
        inliers.begin(), inliers.end(), [&](const RayMatch& m) { return IsGood(pose, E, m); });
    votes.push_back({pose, static_cast<std::size_t>(good)});
  }
  std::stable_sort(votes.begin(), votes.end(), [](const MotionVote& a, const MotionVote& b) {
    return a.good > b.good;
  });
  return votes;
}

void MarkGood(std::span<const RayMatch> matches, TwoViewSolution& solution) {
  const Rigid3& pose = solution.b_from_a;
  const Eigen::Matrix3d E = Skew(pose.translation) * pose.rotation.toRotationMatrix();
  std::vector<RayMatch> good;
  for (const RayMatch& match : matches) {
    solution.is_good.push_back(IsGood(pose, E, match));
    if (solution.is_good.back()) good.push_back(match);
  }
  solution.parallax_deg = ParallaxOf(kMinPoints, good, pose.rotation) / kDegree;
}

InitializationStatus Verdict(std::span<const MotionVote> votes,
                             std::size_t inliers,
                             TwoViewModel model,
                             double parallax_deg) {
  const std::size_t best = votes.front().good;
  const double rival_part =
      model == TwoViewModel::kFundamental ? kRivalPartOfFundamental : kRivalPartOfHomography;
  const double required =
      std::max(static_cast<double>(kMinPoints), kMinGoodPart * static_cast<double>(inliers));
  if (parallax_deg < kMinParallaxDeg) return InitializationStatus::kTooLittleParallax;
  if (votes.size() > 1 &&
      static_cast<double>(votes[1].good) > rival_part * static_cast<double>(best)) {
    return InitializationStatus::kAmbiguous;
  }
  if (static_cast<double>(best) < required) return InitializationStatus::kInaccurate;
  return InitializationStatus::kNone;
}

// A pixel as a distance between rays.
double PixelOf(const RectifiedCamera& camera) { return 2 / (camera.fx + camera.fy); }

}  // namespace

double EpipolarScore(const Eigen::Matrix3d& fundamental, std::span<const RayMatch> matches) {
  double score = 0;
  for (const RayMatch& m : matches) {
    for (const double chi2 : EpipolarChi2(fundamental, m)) score += Gain(chi2, kChi2OneDof95);
  }
  return score;
}

double TransferScore(const Eigen::Matrix3d& homography, std::span<const RayMatch> matches) {
  const Eigen::Matrix3d inverse = homography.inverse();
  double score = 0;
  for (const RayMatch& m : matches) {
    for (const double chi2 : TransferChi2(homography, inverse, m)) {
      score += Gain(chi2, kChi2TwoDof95);
    }
  }
  return score;
}

TwoViewSolution SolveTwoViews(std::span<const RayMatch> measured, double pixel, Rng& rng) {
  TwoViewSolution solution;
  solution.wait = InitializationStatus::kTooFewMatches;
  if (measured.size() < kMinMatches) return solution;
  std::vector<RayMatch> matches(measured.begin(), measured.end());
  for (RayMatch& match : matches) match.sigma_a = match.sigma_b = pixel;
  const BothModels best = BestModels(matches, rng);
  const double epipolar = best.fundamental.score;
  const double transfer = best.homography.score;
  if (!(epipolar + transfer > 0)) return solution;
  const bool plane = transfer > kHomographyShare * (transfer + epipolar);
  solution.model = plane ? TwoViewModel::kHomography : TwoViewModel::kFundamental;
  const Eigen::Matrix3d& model = plane ? best.homography.matrix : best.fundamental.matrix;

  const std::vector<RayMatch> inliers = Inliers(model, solution.model, matches);
  const std::vector<MotionVote> votes = Vote(MotionsOf(model, solution.model), inliers);
  if (votes.empty()) {  // the homography is a mere turn
    solution.wait = InitializationStatus::kTooLittleParallax;
    return solution;
  }
  solution.b_from_a = votes.front().pose;
  MarkGood(matches, solution);
  solution.wait = Verdict(votes, inliers.size(), solution.model, solution.parallax_deg);
  return solution;
}

InitializationResult TwoViewInitializer::Add(const InitializationFrame& frame) {
  using enum InitializationStatus;
  const Features& features = frame.indexed->features;
  if (features.points.size() < kMinFeatures) {
    Reset();
    return {.wait = kTooFewFeatures};
  }
  if (!reference_) {
    reference_ = frame;
    return {.wait = kTooFewFrames};
  }
  const Features& before = reference_->indexed->features;
  const ReferenceMatches matches = MatchToReference(before, features, motion_);
  InitializationResult result{.matches = static_cast<int>(matches.points.size())};
  if (matches.points.size() < kMinMatches) {
    reference_ = frame;
    motion_ = {};
    result.wait = kTooFewMatches;
    return result;
  }
  motion_ = matches.motion;
  Rng rng(seed_, "two_view", static_cast<std::uint64_t>(frame.id.value));
  const auto rays = RayMatchesOf(camera_, before, features, matches.points);
  ++counts_.two_view_solutions;
  const TwoViewSolution solution = SolveTwoViews(rays, PixelOf(camera_), rng);
  result.parallax_deg = solution.parallax_deg;
  result.wait = solution.wait;
  if (result.wait != kNone) return result;
  std::vector<FeatureTrack> points;
  for (std::size_t i = 0; i < matches.points.size(); ++i) {
    if (!solution.is_good[i]) continue;
    points.push_back({{0, matches.points[i].a}, {1, matches.points[i].b}});
  }
  std::vector<FeatureTrack> lines;
  for (const FeatureMatch& match : matches.lines) lines.push_back({{0, match.a}, {1, match.b}});
  result.map = TriangulateAndAdjustMap(
      camera_, {{*reference_, {}}, {frame, solution.b_from_a}}, points, lines, kMinPoints);
  if (!result.map) result.wait = kInaccurate;
  return result;
}

void TwoViewInitializer::Reset() {
  reference_.reset();
  motion_ = {};
}

InitializationResult TwoViewImagesInitializer::Add(const InitializationFrame& frame) {
  using enum InitializationStatus;
  InitializationResult result = window_.Offer(frame, 1);
  if (result.wait != kNone) return result;
  const std::vector<int> newest{window_.size() - 1};
  const FeatureTracks tracks = window_.CollectTracks(newest, std::numeric_limits<int>::max());
  Rng rng(seed_, "two_view", static_cast<std::uint64_t>(frame.id.value));
  ++counts_.aligned_images;
  ++counts_.two_view_solutions;
  const TwoViewSolution solution =
      SolveTwoViews(MatchesBetween(tracks.reference, tracks.views.front()), PixelOf(camera_), rng);
  result.parallax_deg = solution.parallax_deg;
  result.wait = solution.wait;
  if (result.wait != kNone) return result;
  std::vector<bool> is_good(window_.reference().indexed->features.points.size(), false);
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    is_good[Index(tracks.features[k])] = solution.is_good[k];
  }
  std::vector<FeatureTrack> points = window_.PointObservations(newest);
  std::erase_if(points,
                [&](const FeatureTrack& track) { return !is_good[Index(track.front().feature)]; });
  result.map = TriangulateAndAdjustMap(camera_,
                                       {{window_.reference(), {}}, {frame, solution.b_from_a}},
                                       points,
                                       window_.LineObservations(newest),
                                       kMinPoints);
  if (!result.map) result.wait = kInaccurate;
  return result;
}

}  // namespace plumbline
