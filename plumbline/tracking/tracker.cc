// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/tracker.h"

#include "plumbline/association/landmark_from_frame.h"

#include <algorithm>
#include <set>
#include <utility>

namespace plumbline {
namespace {

// Keyframes' landmarks count as well observed from this many views on (fewer in a young map).
constexpr int kWellObserved = 3;
// With one camera a landmark has two views from its first day on; where few grow older, waiting for
// a third would let all go before a keyframe is made.
constexpr int kWellObservedByOne = 2;

template <class LandmarkId, class Candidate>
std::vector<LandmarkId> IdsOfMatches(const std::vector<int>& match_of_feature,
                                     const std::vector<Candidate>& candidates) {
  std::vector<LandmarkId> ids(match_of_feature.size());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (match_of_feature[i] >= 0)
      ids[i] = candidates[static_cast<std::size_t>(match_of_feature[i])].id;
  }
  return ids;
}

// Adds the snapshot's landmarks that are not among the candidates yet.
template <class Candidate, class Landmark>
void AddRest(const std::vector<Landmark>& landmarks, std::vector<Candidate>& candidates) {
  std::set<decltype(Candidate::id)> known;
  for (const Candidate& candidate : candidates) known.insert(candidate.id);
  for (const Landmark& landmark : landmarks) {
    if (!known.contains(landmark.id)) candidates.push_back({landmark.id, landmark});
  }
}

template <class Candidate, class LandmarkId>
void ScoreKind(const std::vector<int>& expected,
               const std::vector<int>& match_of_feature,
               const std::vector<Candidate>& candidates,
               std::map<LandmarkId, TrackingScore>& scores) {
  const auto entry = [&](int candidate) -> TrackingScore* {
    const LandmarkId id = candidates[static_cast<std::size_t>(candidate)].id;
    return id.valid() ? &scores.try_emplace(id, TrackingScore{0, 0}).first->second : nullptr;
  };
  for (const int candidate : expected) {
    if (TrackingScore* score = entry(candidate)) ++score->visible;
  }
  for (const int candidate : match_of_feature) {
    if (candidate < 0) continue;
    if (TrackingScore* score = entry(candidate)) ++score->found;
  }
}

// Counts the landmarks of a keyframe that `needed` keyframes show, and those that a frame shows
// too.
template <class LandmarkId>
void CountShared(const std::vector<LandmarkId>& of_keyframe,
                 const std::vector<LandmarkId>& of_frame,
                 const MapSnapshot& snapshot,
                 int needed,
                 KeyFrameSituation& situation) {
  std::vector<LandmarkId> known;
  for (const LandmarkId id : of_keyframe) {
    const auto* landmark = id.valid() ? snapshot.Find(id) : nullptr;
    if (landmark != nullptr && landmark->observation_count >= needed) known.push_back(id);
  }
  std::sort(known.begin(), known.end());
  situation.reference_landmarks += static_cast<int>(known.size());
  situation.shared_landmarks +=
      static_cast<int>(std::count_if(of_frame.begin(), of_frame.end(), [&](LandmarkId id) {
        return std::binary_search(known.begin(), known.end(), id);
      }));
}

// The landmark of the map that a feature of the last frame showed; nullptr when it is not in the
// snapshot (any more): removed, merged into another, or never in the map.
template <class Candidate>
auto InSnapshot(const std::vector<Candidate>& candidates, int match, const MapSnapshot& snapshot)
    -> decltype(snapshot.Find(Candidate{}.id)) {
  if (match < 0) return nullptr;
  const auto id = candidates[static_cast<std::size_t>(match)].id;
  return id.valid() ? snapshot.Find(id) : nullptr;
}

}  // namespace

TrackerState NextState(TrackerState state, bool has_pose, int lost_frames, int new_map_after) {
  if (has_pose) return TrackerState::kTracking;
  if (state == TrackerState::kInitializing) return TrackerState::kInitializing;
  return lost_frames >= new_map_after ? TrackerState::kInitializing : TrackerState::kLost;
}

Tracker::Tracker(const ImagingModel& imaging,
                 const TrackingOptions& options,
                 const LineOptions& lines,
                 const CuttingOptions& cutting,
                 const Rigid3& world_from_first_cam)
    : imaging_(imaging),
      options_(options),
      lines_(lines),
      cutting_(cutting),
      first_cam_from_world_(Inverse(world_from_first_cam)) {}

TrackingResult Tracker::Track(FrameId id,
                              std::int64_t stamp_ns,
                              std::shared_ptr<const IndexedFeatures> indexed,
                              const MapSnapshot* snapshot,
                              bool mapping_behind) {
  Frame frame;
  frame.id = id;
  frame.stamp_ns = stamp_ns;
  frame.points.resize(indexed->features.points.size());
  frame.lines.resize(indexed->features.lines.size());
  frame.indexed = snapshot != nullptr ? WithCorrection(indexed, snapshot->stereo_correction)
                                      : std::move(indexed);
  if (state_ == TrackerState::kInitializing) return StartMap(std::move(frame));
  PLUMBLINE_CHECK(snapshot != nullptr, "tracking without a map");
  return Follow(std::move(frame), *snapshot, mapping_behind);
}

TrackingResult Tracker::StartMap(Frame frame) {
  const Features& features = frame.features();
  const auto with_depth =
      std::count_if(features.point_disparity.begin(),
                    features.point_disparity.end(),
                    [](const auto& disparity) { return disparity.has_value(); }) +
      std::count_if(features.line_right.begin(), features.line_right.end(), [](const auto& right) {
        return right.has_value();
      });
  if (with_depth < options_.min_initial) {
    return Fail(std::move(frame), TrackingFailure::kTooFewFeatures, {});
  }
  frame.cam_from_world = first_cam_from_world_;
  scores_ = {};
  TrackingResult result;
  result.keyframe = MakeKeyFrame(frame, KeyFrameId{}, KeyFrameReason::kNone);
  result.starts_map = true;
  result.cam_from_world = frame.cam_from_world;
  result.frame = frame;
  result.reference = newest_keyframe_;
  state_ = NextState(state_, true, 0, options_.new_map_after);
  result.state = state_;
  lost_frames_ = 0;
  velocity_.setZero();
  spread_.reset();
  const std::size_t points = frame.points.size();
  const std::size_t lines = frame.lines.size();
  last_ = LastFrame{std::move(frame), FrameAssociation(points, lines), newest_keyframe_, Rigid3{}};
  return result;
}

TrackingResult Tracker::StartFrom(const MapSnapshot& snapshot, const Vector6d& velocity) {
  const Frame& frame = snapshot.reference->frame;
  newest_keyframe_ = snapshot.centre;
  next_keyframe_ = KeyFrameId{newest_keyframe_.value + 1};
  frames_since_keyframe_ = 0;
  scores_ = {};
  lost_frames_ = 0;
  trial_keyframes_ = options_.trial_keyframes;
  velocity_ = velocity;
  spread_.reset();
  state_ = NextState(state_, true, 0, options_.new_map_after);
  FrameAssociation association = AssociationOf(frame, snapshot);
  TrackingResult result;
  result.state = state_;
  result.counts.matched_points = result.counts.inlier_points = association.PointMatches();
  result.counts.matched_lines = result.counts.inlier_lines = association.LineMatches();
  result.cam_from_world = frame.cam_from_world;
  result.reference = newest_keyframe_;
  result.frame = frame;
  last_ = LastFrame{frame, std::move(association), newest_keyframe_, Rigid3{}};
  return result;
}

TrackingResult Tracker::Follow(Frame frame, const MapSnapshot& snapshot, bool mapping_behind) {
  ++frames_since_keyframe_;
  const Rigid3 last_pose = LastPose(snapshot);
  FrameAssociation association;
  TrackingResult result;
  const double seconds = 1e-9 * static_cast<double>(frame.stamp_ns - last_->frame.stamp_ns);
  PosePrior predicted = Predict(last_pose, seconds);
  auto first = FromPrediction(frame, predicted, snapshot, association);
  if (!first) {
    predicted.information.setZero();
    first = FromAppearance(frame, last_pose, snapshot, association, result.counts);
  }
  if (!first) {
    const int matches = result.counts.matched_points + result.counts.matched_lines;
    return Fail(std::move(frame),
                matches < options_.min_inliers ? TrackingFailure::kTooFewMatches
                                               : TrackingFailure::kTooFewInliers,
                result.counts);
  }
  const bool odometry = options_.reference == TrackingReference::kLastFrame;
  const PoseEstimate pose =
      odometry ? WithLastFrame(frame, *first, predicted, association, result.counts)
               : WithLocalMap(frame, *first, predicted, snapshot, association, result.counts);
  result.counts.inlier_points = pose.inlier_points;
  result.counts.inlier_lines = pose.inlier_lines;
  if (pose.Inliers() < options_.min_inliers) {
    return Fail(std::move(frame), TrackingFailure::kTooFewInliers, result.counts);
  }
  if (!Accepted(pose)) {
    return Fail(std::move(frame), TrackingFailure::kPoseNotObservable, result.counts);
  }

  frame.cam_from_world = pose.cam_from_world;
  frame.points = IdsOfMatches<PointId>(association.point_of_feature, association.points);
  frame.lines = IdsOfMatches<LineId>(association.line_of_feature, association.lines);
  velocity_ = LogSe3(frame.cam_from_world * Inverse(last_pose)) / seconds;
  spread_ = Spread{pose.information.inverse(), pose.scene_depth};
  lost_frames_ = 0;
  state_ = NextState(state_, true, 0, options_.new_map_after);
  result.state = state_;
  result.cam_from_world = frame.cam_from_world;
  result.reference = snapshot.centre;
  result.cam_from_reference =
      frame.cam_from_world * Inverse(snapshot.cam_from_world.at(snapshot.centre));
  KeyFrameReason reason = KeyFrameReason::kNone;
  if (!odometry) {
    KeyFrameSituation situation = Situation(frame, association, snapshot);
    situation.mapping_behind = mapping_behind;
    reason = DecideKeyFrame(situation, options_.keyframes);
  }
  if (reason != KeyFrameReason::kNone) {
    result.keyframe = MakeKeyFrame(frame, snapshot.centre, reason);
    result.reference = newest_keyframe_;
    result.cam_from_reference = Rigid3{};
  }
  result.frame = frame;
  last_ = LastFrame{
      std::move(frame), std::move(association), result.reference, result.cam_from_reference};
  return result;
}

// The last frame's pose, moved with its reference keyframe by what optimization has done since.
Rigid3 Tracker::LastPose(const MapSnapshot& snapshot) const {
  const auto it = snapshot.cam_from_world.find(last_->reference);
  if (it == snapshot.cam_from_world.end()) return last_->frame.cam_from_world;
  return last_->cam_from_reference * it->second;
}

// Constant velocity; it may change by motion_sigma a second, the translation in the unit of the
// scene's depth. The last pose adds its own covariance.
PosePrior Tracker::Predict(const Rigid3& last_pose, double seconds) const {
  PosePrior prior{RetractLeft(last_pose, seconds * velocity_)};
  if (!spread_) return prior;
  Vector6d sigma = Vector6d::Constant(options_.motion_sigma * seconds * seconds);
  sigma.tail<3>() *= spread_->scene_depth;
  Matrix6d covariance = spread_->covariance;
  covariance.diagonal() += sigma.cwiseAbs2();
  prior.information = covariance.inverse();
  return prior;
}

// What the last frame showed: its landmarks as they are in the snapshot, and new ones from its
// depths, at the places that go with its pose of today.
FrameAssociation Tracker::LastLandmarks(const MapSnapshot& snapshot,
                                        const Frame& frame,
                                        Depths depths) const {
  const double worst = options_.worst_relative_depth_sigma;
  const bool known_only = depths == Depths::kKnown;
  const double point_sigma = known_only ? options_.max_relative_depth_sigma : worst;
  const double line_sigma = known_only ? options_.max_relative_line_depth_sigma : worst;
  FrameAssociation result(frame.points.size(), frame.lines.size());
  Frame last = last_->frame;
  last.cam_from_world = LastPose(snapshot);
  const FrameAssociation& before = last_->association;
  for (std::size_t i = 0; i < last.points.size(); ++i) {
    const auto* known = InSnapshot(before.points, before.point_of_feature[i], snapshot);
    if (known != nullptr) {
      result.points.push_back({known->id, *known});
    } else if (const auto point = PointFromFrame(imaging_.camera, last, i, point_sigma)) {
      result.points.push_back({PointId{}, *point});
    }
  }
  const auto scene = depths == Depths::kGuessed ? SceneDisparity(last) : std::nullopt;
  for (std::size_t i = 0; i < last.lines.size(); ++i) {
    const auto* known = InSnapshot(before.lines, before.line_of_feature[i], snapshot);
    if (known != nullptr) {
      result.lines.push_back({known->id, *known});
    } else if (const auto line = LineFromFrame(imaging_.camera, last, i, line_sigma)) {
      result.lines.push_back({LineId{}, *line});
    } else if (scene) {
      result.lines.push_back({LineId{}, LineAtSceneDepth(imaging_.camera, last, i, *scene)});
    }
  }
  return result;
}

PoseEstimate Tracker::Estimate(const Frame& frame,
                               const Rigid3& initial,
                               const PosePrior& prior,
                               FrameAssociation& association) const {
  return EstimatePose(imaging_.camera,
                      frame.features(),
                      initial,
                      lines_,
                      cutting_,
                      options_.pose,
                      association,
                      prior);
}

std::optional<PoseEstimate> Tracker::SearchLast(const Frame& frame,
                                                const PosePrior& predicted,
                                                const MapSnapshot& snapshot,
                                                const LastSearch& how,
                                                FrameAssociation& association) const {
  association = LastLandmarks(snapshot, frame, how.depths);
  ProjectionSearchOptions search = options_.search;
  search.point_radius_px = how.factor * options_.first_radius_px;
  search.line_offset_px = how.factor * options_.first_radius_px;
  MatchCandidates(imaging_, *frame.indexed, predicted.cam_from_world, search, association);
  const int matches = association.PointMatches() + association.LineMatches();
  if (matches < options_.min_inliers) return std::nullopt;
  const PoseEstimate estimate = Estimate(frame, predicted.cam_from_world, predicted, association);
  if (!Accepted(estimate) || estimate.Inliers() * 3 < matches) return std::nullopt;
  return estimate;
}

std::optional<PoseEstimate> Tracker::FromPrediction(const Frame& frame,
                                                    const PosePrior& predicted,
                                                    const MapSnapshot& snapshot,
                                                    FrameAssociation& association) const {
  std::optional<PoseEstimate> best;
  for (const LastSearch& how : {LastSearch{Depths::kKnown, 1},
                                LastSearch{Depths::kUncertain, 1},
                                LastSearch{Depths::kGuessed, 1},
                                LastSearch{Depths::kGuessed, options_.wide_factor}}) {
    // Guesses may be wrong: only where needed.
    const double limit =
        how.depths == Depths::kGuessed ? options_.guess_pose_sigma : options_.enough_pose_sigma;
    if (best && best->sigma.AtMost(limit)) break;
    FrameAssociation found;
    const auto estimate = SearchLast(frame, predicted, snapshot, how, found);
    if (!estimate || (best && estimate->Inliers() <= best->Inliers())) continue;
    best = estimate;
    association = std::move(found);
  }
  return best;
}

std::optional<CandidatePoint> Tracker::PointOf(const Frame& frame,
                                               std::size_t feature,
                                               const MapSnapshot& snapshot) const {
  if (options_.reference == TrackingReference::kLastFrame) {
    const double sigma = options_.worst_relative_depth_sigma;
    const auto point = PointFromFrame(imaging_.camera, frame, feature, sigma);
    return point ? std::optional(CandidatePoint{PointId{}, *point}) : std::nullopt;
  }
  const PointId id = frame.points[feature];
  const SnapshotPoint* point = id.valid() ? snapshot.Find(id) : nullptr;
  return point != nullptr ? std::optional(CandidatePoint{id, *point}) : std::nullopt;
}

std::optional<CandidateLine> Tracker::LineOf(const Frame& frame,
                                             std::size_t feature,
                                             const MapSnapshot& snapshot) const {
  if (options_.reference == TrackingReference::kLastFrame) {
    const double sigma = options_.worst_relative_depth_sigma;
    const auto line = LineFromFrame(imaging_.camera, frame, feature, sigma);
    return line ? std::optional(CandidateLine{LineId{}, *line}) : std::nullopt;
  }
  const LineId id = frame.lines[feature];
  const SnapshotLine* line = id.valid() ? snapshot.Find(id) : nullptr;
  return line != nullptr ? std::optional(CandidateLine{id, *line}) : std::nullopt;
}

std::optional<PoseEstimate> Tracker::FromAppearance(const Frame& frame,
                                                    const Rigid3& initial,
                                                    const MapSnapshot& snapshot,
                                                    FrameAssociation& association,
                                                    FrameCounts& counts) const {
  association = FrameAssociation(frame.points.size(), frame.lines.size());
  const bool odometry = options_.reference == TrackingReference::kLastFrame;
  const Frame& reference = odometry ? last_->frame : snapshot.reference->frame;
  const auto point_matches = MatchPoints(
      reference.features().points, frame.features().points, {.max_distance = 60, .ratio = 0.8});
  for (const PointMatch& match : point_matches) {
    const auto point = PointOf(reference, static_cast<std::size_t>(match.a), snapshot);
    if (!point) continue;
    association.point_of_feature[static_cast<std::size_t>(match.b)] =
        static_cast<int>(association.points.size());
    association.points.push_back(*point);
  }
  const auto line_matches =
      MatchLines(reference.features().lines, frame.features().lines, LineMatchOptions{});
  for (const LineMatch& match : line_matches) {
    const auto line = LineOf(reference, static_cast<std::size_t>(match.a), snapshot);
    if (!line) continue;
    association.line_of_feature[static_cast<std::size_t>(match.b)] =
        static_cast<int>(association.lines.size());
    association.lines.push_back(*line);
  }
  counts.matched_points = association.PointMatches();
  counts.matched_lines = association.LineMatches();
  const int needed = options_.min_unpredicted_inliers;
  if (counts.matched_points + counts.matched_lines < needed) return std::nullopt;
  const PoseEstimate estimate = Estimate(frame, initial, {}, association);
  if (!estimate.Accepted(needed, options_.max_pose_sigma)) return std::nullopt;
  return estimate;
}

PoseEstimate Tracker::WithLastFrame(const Frame& frame,
                                    const PoseEstimate& first,
                                    const PosePrior& prior,
                                    FrameAssociation& association,
                                    FrameCounts& counts) const {
  MatchCandidates(imaging_, *frame.indexed, first.cam_from_world, options_.search, association);
  counts.matched_points = association.PointMatches();
  counts.matched_lines = association.LineMatches();
  return Estimate(frame, first.cam_from_world, prior, association);
}

PoseEstimate Tracker::EstimateNotOutvoted(const Frame& frame,
                                          const Rigid3& initial,
                                          const PosePrior& prior,
                                          const MapSnapshot& snapshot,
                                          FrameAssociation& association) const {
  constexpr double kOutvoted = 0.95;  // of the established that agree by themselves
  const int views =
      std::min(options_.established_views, static_cast<int>(snapshot.cam_from_world.size()));
  FrameAssociation established = association;
  FrameAssociation young = TakeOutYoung(snapshot, views, established);
  FrameAssociation all = std::move(association);
  const PoseEstimate of_all = Estimate(frame, initial, prior, all);
  association = established;
  const PoseEstimate of_established = Estimate(frame, initial, prior, association);
  if (!Accepted(of_established) || !of_established.sigma.AtMost(options_.enough_pose_sigma) ||
      CommonMatches(association, all) >= kOutvoted * of_established.Inliers()) {
    association = std::move(all);
    return of_all;
  }
  DropDisagreeing(imaging_.camera,
                  frame.features(),
                  of_established.cam_from_world,
                  lines_,
                  options_.pose.gate_scale,
                  young);
  PutBack(young, established);
  association = std::move(established);
  return Estimate(frame, of_established.cam_from_world, prior, association);
}

PoseEstimate Tracker::WithLocalMap(const Frame& frame,
                                   const PoseEstimate& first,
                                   const PosePrior& prior,
                                   const MapSnapshot& snapshot,
                                   FrameAssociation& association,
                                   FrameCounts& counts) {
  // Landmarks of the map come before those made on the spot from the last frame: these know the
  // pose from one frame only, and would keep the map's from being found.
  FrameAssociation with_map(frame.points.size(), frame.lines.size());
  CopyMatches(association, true, with_map);
  AddRest(snapshot.points, with_map.points);
  AddRest(snapshot.lines, with_map.lines);
  const ExpectedLandmarks expected =
      MatchCandidates(imaging_, *frame.indexed, first.cam_from_world, options_.search, with_map);
  CopyMatches(association, false, with_map);
  association = std::move(with_map);
  counts.matched_points = association.PointMatches();
  counts.matched_lines = association.LineMatches();
  PoseEstimate estimate =
      EstimateNotOutvoted(frame, first.cam_from_world, prior, snapshot, association);
  Score(expected, association);
  return estimate;
}

void Tracker::Score(const ExpectedLandmarks& expected, const FrameAssociation& association) {
  ScoreKind(expected.points, association.point_of_feature, association.points, scores_.points);
  ScoreKind(expected.lines, association.line_of_feature, association.lines, scores_.lines);
}

KeyFrameSituation Tracker::Situation(const Frame& frame,
                                     const FrameAssociation& association,
                                     const MapSnapshot& snapshot) const {
  KeyFrameSituation situation;
  situation.monocular = imaging_.camera.baseline == 0;
  situation.frames_since_keyframe = static_cast<int>(frames_since_keyframe_);
  const Frame& reference = snapshot.reference->frame;
  const int needed = std::min(situation.monocular ? kWellObservedByOne : kWellObserved,
                              static_cast<int>(snapshot.cam_from_world.size()));
  CountShared(reference.points, frame.points, snapshot, needed, situation);
  CountShared(reference.lines, frame.lines, snapshot, needed, situation);
  const auto& disparities = frame.features().point_disparity;
  for (std::size_t i = 0; i < disparities.size(); ++i) {
    if (!disparities[i] ||
        disparities[i]->sigma_px > options_.close_relative_depth_sigma * disparities[i]->px) {
      continue;
    }
    const bool tracked = association.point_of_feature[i] >= 0 && frame.points[i].valid();
    ++(tracked ? situation.close_tracked : situation.close_untracked);
  }
  return situation;
}

TrackingResult Tracker::Fail(Frame frame, TrackingFailure failure, FrameCounts counts) {
  ++lost_frames_;
  // A map that loses the camera right after its start was a bad one more often than not.
  const int patience = trial_keyframes_ > 0 ? 1 : options_.new_map_after;
  state_ = NextState(state_, false, lost_frames_, patience);
  velocity_.setZero();
  spread_.reset();
  TrackingResult result;
  result.state = state_;
  result.failure = failure;
  result.counts = counts;
  result.frame = std::move(frame);
  return result;
}

NewKeyFrame Tracker::MakeKeyFrame(const Frame& frame, KeyFrameId parent, KeyFrameReason reason) {
  newest_keyframe_ = next_keyframe_;
  next_keyframe_ = KeyFrameId{next_keyframe_.value + 1};
  frames_since_keyframe_ = 0;
  if (trial_keyframes_ > 0) --trial_keyframes_;
  return {{newest_keyframe_, parent, frame}, reason, std::exchange(scores_, {})};
}

}  // namespace plumbline
