// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/pose_search.h"

#include "plumbline/features/match_lines.h"
#include "plumbline/features/match_points.h"
#include "plumbline/geometry/measured_depth.h"
#include "plumbline/matching/landmark_from_frame.h"
#include "plumbline/matching/line_matching.h"
#include "plumbline/solvers/absolute_pose.h"
#include "plumbline/tracking/landmark_matches.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

// Largest deviation of the depth, relative to the depth, of landmarks made from one frame. The
// first limit is for points, the second for the ends of lines, whose weights allow for more. The
// third is for both if the first two leave too few landmarks.
constexpr double kMaxDepthSigma = 0.05;
constexpr double kMaxLineDepthSigma = 0.15;
constexpr double kWorstDepthSigma = 0.3;
// Lines at a guessed depth are searched only if the deviation of the pose is above this.
constexpr double kGuessPoseSigma = 0.01;

// Finds a landmark of the map; nullptr for an invalid id, and for a landmark that is not in the
// snapshot or is so no longer.
template <class Id>
auto InSnapshot(Id id, const MapSnapshot& snapshot) -> decltype(snapshot.Find(id)) {
  return id.valid() ? snapshot.Find(id) : nullptr;
}

// Finds the landmark of the map that a feature of the last frame showed; nullptr when it is not in
// the snapshot, because it was removed, merged into another, or never in the map.
template <class Candidate>
auto InSnapshot(const std::vector<Candidate>& candidates, int match, const MapSnapshot& snapshot)
    -> decltype(snapshot.Find(Candidate{}.id)) {
  return match < 0 ? nullptr : InSnapshot(candidates[static_cast<std::size_t>(match)].id, snapshot);
}

// Counts the matches. The counts of inliers stay zero, as these are not known yet.
FrameCounts CountsOf(const FrameMatches& matches) {
  return {.matched_points = matches.Points(), .matched_lines = matches.Lines()};
}

std::vector<PointInImage> MatchedPoints(const Frame& frame, const LandmarkMatches& association) {
  std::vector<PointInImage> result;
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    const int match = association.matches.point_of_feature[i];
    if (match < 0) continue;
    result.push_back({association.points[static_cast<std::size_t>(match)].model.position,
                      frame.features().points[i].px});
  }
  return result;
}

}  // namespace

ProjectionSearchOptions FirstSearch(double factor) {
  constexpr double kRadiusPx = 12;
  ProjectionSearchOptions search;
  search.point_radius_px = factor * kRadiusPx;
  search.line_offset_px = factor * kRadiusPx;
  return search;
}

bool MoreThanChance(int agreeing, int matches) {
  // The pose is fixed by so many points, which agree with it in any case.
  constexpr int kFitted = 3;
  // The gate of a corner that is known to half a pixel, 1.2 px, covers a tenth of the window of 4
  // px in which the map is searched.
  constexpr double kByChance = 0.1;
  constexpr double kDeviations = 3;
  const double mean = kByChance * std::max(0, matches - kFitted);
  return agreeing >=
         std::min(matches, kFitted) + mean + kDeviations * std::sqrt(mean * (1 - kByChance));
}

PoseSearch::PoseSearch(const CameraAndPyramid& imaging,
                       const TrackingOptions& options,
                       const PoseEstimator& estimator)
    : imaging_(imaging), options_(options), estimator_(estimator) {}

// Collects the landmarks of the last frame: those in the snapshot, and new ones from its depths, by
// its pose in the snapshot.
LandmarkMatches PoseSearch::LastLandmarks(const LastFrame& last,
                                          const MapSnapshot& snapshot,
                                          const Frame& frame,
                                          Depths depths) const {
  const bool known_only = depths == Depths::kKnown;
  const double point_sigma = known_only ? kMaxDepthSigma : kWorstDepthSigma;
  const double line_sigma = known_only ? kMaxLineDepthSigma : kWorstDepthSigma;
  LandmarkMatches result(frame.points.size(), frame.lines.size());
  result.made_from = last.frame.cam_from_world;
  const LandmarkMatches& before = last.association;
  for (std::size_t i = 0; i < last.frame.points.size(); ++i) {
    const auto* known = InSnapshot(before.points, before.matches.point_of_feature[i], snapshot);
    auto point = PointOf(known, last.frame, i, point_sigma);
    if (!point) continue;
    // The deviations of the map's landmarks do not count; next to them, points with well known
    // depths are as good as exact.
    if (known_only && !IsOdometry()) point->covariance.setZero();
    result.points.push_back(*point);
  }
  const auto scene = depths == Depths::kGuessed ? SceneDisparity(last.frame) : std::nullopt;
  for (std::size_t i = 0; i < last.frame.lines.size(); ++i) {
    const auto* known = InSnapshot(before.lines, before.matches.line_of_feature[i], snapshot);
    if (const auto line = LineOf(known, last.frame, i, line_sigma)) {
      result.lines.push_back(*line);
    } else if (scene) {
      result.lines.push_back({LineId{}, LineAtSceneDepth(imaging_.camera, last.frame, i, *scene)});
    }
  }
  return result;
}

std::optional<PoseEstimate> PoseSearch::SearchLast(const Frame& frame,
                                                   const PosePrior& predicted,
                                                   const LastFrame& last,
                                                   const MapSnapshot& snapshot,
                                                   const LastSearch& how,
                                                   LandmarkMatches& association) const {
  association = LastLandmarks(last, snapshot, frame, how.depths);
  MatchCandidates(
      imaging_, *frame.indexed, predicted.cam_from_world, FirstSearch(how.factor), association);
  const int matches = association.matches.All();
  if (matches < kFewestInliers) return std::nullopt;
  const PoseEstimate estimate =
      estimator_.Estimate(frame.features(), predicted.cam_from_world, predicted, association);
  if (!Accepted(estimate) || !MoreThanChance(estimate.Inliers(), matches)) return std::nullopt;
  return estimate;
}

std::optional<PoseEstimate> PoseSearch::FromPrediction(const Frame& frame,
                                                       const PosePrior& predicted,
                                                       const LastFrame& last,
                                                       const MapSnapshot& snapshot,
                                                       LandmarkMatches& association,
                                                       double factor) const {
  std::optional<PoseEstimate> best;
  for (const LastSearch& how : {LastSearch{Depths::kKnown, factor},
                                LastSearch{Depths::kUncertain, factor},
                                LastSearch{Depths::kGuessed, factor},
                                LastSearch{Depths::kGuessed, kWideFactor}}) {
    // Guessed depths may be wrong, so that they are used only if needed.
    const double limit =
        how.depths == Depths::kGuessed ? kGuessPoseSigma : options_.enough_pose_sigma;
    const bool many =
        how.depths == Depths::kGuessed || (best && best->Inliers() >= options_.enough_inliers);
    if (best && best->sigma.AtMost(limit) && many) break;
    // One camera measures no depths.
    if (how.depths == Depths::kUncertain && !MeasuresDepth(imaging_.camera)) continue;
    LandmarkMatches found;
    const auto estimate = SearchLast(frame, predicted, last, snapshot, how, found);
    if (!estimate || (best && estimate->Inliers() <= best->Inliers())) continue;
    best = estimate;
    association = std::move(found);
  }
  return best;
}

std::optional<PointCandidate> PoseSearch::PointOf(const SnapshotPoint* known,
                                                  const Frame& frame,
                                                  std::size_t feature,
                                                  double max_relative_sigma) const {
  if (known != nullptr) return PointCandidate{.id = known->id, .model = *known};
  const auto point = PointFromFrame(imaging_.camera, frame, feature, max_relative_sigma);
  if (!point) return std::nullopt;
  PointCandidate candidate{.id = {}, .model = *point};
  if (options_.point_covariance) {
    candidate.covariance = PointCovarianceFromFrame(imaging_.camera, frame, feature);
  }
  return candidate;
}

std::optional<LineCandidate> PoseSearch::LineOf(const SnapshotLine* known,
                                                const Frame& frame,
                                                std::size_t feature,
                                                double max_relative_sigma) const {
  if (known != nullptr) return LineCandidate{known->id, *known};
  const auto line = LineFromFrame(imaging_.camera, frame, feature, max_relative_sigma);
  return line ? std::optional(LineCandidate{LineId{}, *line}) : std::nullopt;
}

LandmarkMatches PoseSearch::MatchAppearance(const Frame& frame,
                                            const Frame& reference,
                                            const MapSnapshot& snapshot) const {
  LandmarkMatches result(frame.points.size(), frame.lines.size());
  const auto point_matches = MatchPoints(
      reference.features().points, frame.features().points, {.max_distance = 60, .ratio = 0.8});
  for (const FeatureMatch& match : point_matches) {
    const auto a = static_cast<std::size_t>(match.a);
    const auto point =
        PointOf(InSnapshot(reference.points[a], snapshot), reference, a, kWorstDepthSigma);
    if (!point) continue;
    result.matches.point_of_feature[static_cast<std::size_t>(match.b)] =
        static_cast<int>(result.points.size());
    result.points.push_back(*point);
  }
  const auto line_matches = MatchLines(
      reference.features().lines, frame.features().lines, LineMatchingOf(estimator_.lines()));
  for (const FeatureMatch& match : line_matches) {
    const auto a = static_cast<std::size_t>(match.a);
    const auto line =
        LineOf(InSnapshot(reference.lines[a], snapshot), reference, a, kWorstDepthSigma);
    if (!line) continue;
    result.matches.line_of_feature[static_cast<std::size_t>(match.b)] =
        static_cast<int>(result.lines.size());
    result.lines.push_back(*line);
  }
  return result;
}

std::optional<PoseEstimate> PoseSearch::FromAppearance(const Frame& frame,
                                                       const LastFrame& last,
                                                       const MapSnapshot& snapshot,
                                                       LandmarkMatches& association,
                                                       FrameCounts& counts) const {
  constexpr double kMaxErrorPx = 4;
  // Wide, because the pose that most points agree with is not the final one.
  constexpr double kGate = 3;
  association =
      MatchAppearance(frame, IsOdometry() ? last.frame : snapshot.reference->frame, snapshot);
  counts = CountsOf(association.matches);
  Rigid3 initial = last.frame.cam_from_world;
  const auto voted =
      PoseFromPoints(imaging_.camera, MatchedPoints(frame, association), kMaxErrorPx);
  if (voted) {
    initial = *voted;
    estimator_.DropDisagreeing(frame.features(), initial, kGate, association);
  }
  if (association.matches.All() < kFewestUnpredictedInliers) return std::nullopt;
  if (IsOdometry()) association.made_from = last.frame.cam_from_world;
  const PoseEstimate estimate = estimator_.Estimate(frame.features(), initial, {}, association);
  if (!estimate.Accepted(kFewestUnpredictedInliers, options_.max_pose_sigma)) return std::nullopt;
  return estimate;
}

PoseAttempt PoseSearch::WithLastFrame(const Frame& frame,
                                      const PoseEstimate& first,
                                      const PosePrior& prior,
                                      LandmarkMatches found) const {
  PoseAttempt attempt{std::move(found), {}, {}, {}};
  LandmarkMatches& association = attempt.association;
  MatchCandidates(imaging_, *frame.indexed, first.cam_from_world, {}, association);
  attempt.counts = CountsOf(association.matches);
  attempt.pose = estimator_.Estimate(frame.features(), first.cam_from_world, prior, association);
  return attempt;
}

PoseEstimate PoseSearch::EstimateFavoringEstablished(const Frame& frame,
                                                     const Rigid3& initial,
                                                     const PosePrior& prior,
                                                     const MapSnapshot& snapshot,
                                                     LandmarkMatches& association) const {
  // Smallest share of the established landmarks that a pose must keep.
  constexpr double kOutvoted = 0.95;
  const int views =
      std::min(options_.established_views, static_cast<int>(snapshot.cam_from_world.size()));
  const FrameMatches offered = association.matches;
  const FrameMatches young = SplitMatches(snapshot, views, association);
  if (young.All() == 0) return estimator_.Estimate(frame.features(), initial, prior, association);
  const FrameMatches established = std::exchange(association.matches, offered);
  PoseEstimate of_all = estimator_.Estimate(frame.features(), initial, prior, association);
  const FrameMatches all = std::exchange(association.matches, established);
  const PoseEstimate of_established =
      estimator_.Estimate(frame.features(), initial, prior, association);
  if (!Accepted(of_established) || !of_established.sigma.AtMost(options_.enough_pose_sigma) ||
      CommonMatches(association.matches, all) >= kOutvoted * of_established.Inliers()) {
    association.matches = all;
    return of_all;
  }
  association.matches = young;
  estimator_.DropDisagreeing(frame.features(), of_established.cam_from_world, 1, association);
  MergeMatches(established, association.matches);
  return estimator_.Estimate(frame.features(), of_established.cam_from_world, prior, association);
}

PoseAttempt PoseSearch::WithLocalMap(const Frame& frame,
                                     const PoseEstimate& first,
                                     const PosePrior& prior,
                                     const MapSnapshot& snapshot,
                                     const LandmarkMatches& found,
                                     const ProjectionSearchOptions& windows) const {
  // Landmarks of the map are searched before those made on the spot from the last frame. The latter
  // know the pose from one frame only, and would keep landmarks of the map from being found.
  PoseAttempt attempt{LandmarkMatches(frame.points.size(), frame.lines.size()), {}, {}, {}};
  LandmarkMatches& association = attempt.association;
  CopyMatches(found, true, association);
  attempt.expected =
      MatchSnapshot(imaging_, *frame.indexed, first.cam_from_world, windows, snapshot, association);
  CopyMatches(found, false, association);
  attempt.counts = CountsOf(association.matches);
  attempt.pose =
      EstimateFavoringEstablished(frame, first.cam_from_world, prior, snapshot, association);
  return attempt;
}

std::optional<PoseAttempt> LocateFrame(const CameraAndPyramid& imaging,
                                       const PoseEstimator& estimator,
                                       const FrameFeatures& image,
                                       const Rigid3& predicted,
                                       const MapSnapshot& snapshot,
                                       double max_pose_sigma) {
  for (const double factor : {1.0, kWideFactor}) {
    PoseAttempt located;
    located.association =
        LandmarkMatches(image.features.points.size(), image.features.lines.size());
    const auto accepted = [&](const Rigid3& initial) {
      located.counts.matched_points = located.association.matches.Points();
      located.counts.matched_lines = located.association.matches.Lines();
      located.pose = estimator.Estimate(image.features, initial, {}, located.association);
      located.counts.inlier_points = located.pose.inlier_points;
      located.counts.inlier_lines = located.pose.inlier_lines;
      return located.pose.Accepted(kFewestUnpredictedInliers, max_pose_sigma);
    };
    MatchSnapshot(imaging, image, predicted, FirstSearch(factor), snapshot, located.association);
    if (!accepted(predicted)) continue;
    const Rigid3 first = located.pose.cam_from_world;
    MatchSnapshot(imaging, image, first, {}, snapshot, located.association);
    if (accepted(first)) return located;
  }
  return std::nullopt;
}

}  // namespace plumbline
