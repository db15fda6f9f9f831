// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/tracker.h"

#include "plumbline/base/error.h"

#include <algorithm>
#include <utility>

namespace plumbline {
namespace {

// Keyframes' landmarks count as well observed from this many views on (fewer in a young map). Not
// tracking.established_views, which is about trust, may be 0 for none, and is the same with one
// camera.
constexpr int kWellObserved = 3;
// With one camera a landmark has two views from its first day on; where few grow older, waiting for
// a third would let all go before a keyframe is made.
constexpr int kWellObservedByOne = 2;
// Depth uncertainty below which a point counts as near, relative to depth: it fixes the
// translation.
constexpr double kCloseDepthSigma = 0.05;
// Change of velocity that the prediction allows for, as hands and cars show it: rotation [rad/s^2]
// and translation [scene depths/s^2].
constexpr double kMotionSigma = 5;

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

// What shows more of the map is right, unless the other shows twice as much in all: things that
// move have many landmarks made on the spot, too, and after a fast motion little of the map is
// left.
bool ShowsMore(const FrameAssociation& a, const FrameAssociation& b) {
  const int all_a = a.matches.All();
  const int all_b = b.matches.All();
  const int map_a = MatchesOfMap(a);
  const int map_b = MatchesOfMap(b);
  const bool no_map = map_a + map_b == 0;  // odometry
  if (no_map || all_a > 2 * all_b || all_b > 2 * all_a) return all_a > all_b;
  return map_a > map_b;
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
                 const Rigid3& world_from_first_cam,
                 double min_lost_seconds)
    : options_(options),
      search_(imaging, options, lines, cutting),
      monocular_(imaging.camera.baseline == 0),
      first_cam_from_world_(Inverse(world_from_first_cam)),
      min_lost_seconds_(min_lost_seconds) {}

TrackingResult Tracker::Track(FrameId id,
                              std::int64_t stamp_ns,
                              std::shared_ptr<const IndexedFeatures> indexed,
                              const MapSnapshot* snapshot,
                              const LiveConditions& live) {
  Frame frame;
  frame.id = id;
  frame.stamp_ns = stamp_ns;
  frame.points.resize(indexed->features.points.size());
  frame.lines.resize(indexed->features.lines.size());
  frame.indexed = snapshot != nullptr ? WithCorrection(indexed, snapshot->stereo_correction)
                                      : std::move(indexed);
  if (state_ == TrackerState::kInitializing) return StartMap(std::move(frame));
  if (!last_) return Fail(std::move(frame), TrackingFailure::kNotRelocalized, {});
  PLUMBLINE_CHECK(snapshot != nullptr, "tracking without a map");
  if (snapshot->withdrawn && !use_) {
    trial_keyframes_ = std::max(trial_keyframes_, 1);  // it did not stand its trial
    return Fail(std::move(frame), TrackingFailure::kMapWithdrawn, {});
  }
  return Follow(std::move(frame), *snapshot, live);
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
  use_.reset();
  scores_ = {};
  TrackingResult result;
  result.keyframe = MakeKeyFrame(frame, KeyFrameId{}, {});
  result.starts_map = true;
  result.cam_from_world = frame.cam_from_world;
  result.frame = frame;
  result.reference = newest_keyframe_;
  state_ = NextState(state_, true, 0, options_.new_map_after);
  result.state = state_;
  lost_frames_ = 0;
  velocity_.reset();
  spread_.reset();
  const std::size_t points = frame.points.size();
  const std::size_t lines = frame.lines.size();
  last_ = Tracked{{std::move(frame), FrameAssociation(points, lines)}, {newest_keyframe_, {}}, {}};
  return result;
}

TrackingResult Tracker::StartFrom(const MapSnapshot& snapshot, const Vector6d& velocity) {
  const Frame& frame = snapshot.reference->frame;
  newest_keyframe_ = snapshot.centre;
  next_keyframe_ = KeyFrameId{newest_keyframe_.value + 1};
  frames_since_keyframe_ = 0;
  use_.reset();
  scores_ = {};
  lost_frames_ = 0;
  trial_keyframes_ = options_.trial_keyframes;
  velocity_ = velocity;
  spread_.reset();
  state_ = NextState(state_, true, 0, options_.new_map_after);
  FrameAssociation association = AssociationOf(frame, snapshot);
  TrackingResult result;
  result.state = state_;
  result.counts.matched_points = result.counts.inlier_points = association.matches.Points();
  result.counts.matched_lines = result.counts.inlier_lines = association.matches.Lines();
  result.cam_from_world = frame.cam_from_world;
  result.reference = newest_keyframe_;
  result.frame = frame;
  result.from_reference.unit = snapshot.reference->unit;
  last_ = Tracked{{frame, std::move(association)}, {newest_keyframe_, result.from_reference}, {}};
  return result;
}

void Tracker::BeginLost(const MapUse& use) {
  state_ = TrackerState::kLost;
  next_keyframe_ = use.next_keyframe;
  use_ = use;
}

void Tracker::Resume(const Relocalized& found, const MapSnapshot& snapshot) {
  const Placement& place = snapshot.places.at(snapshot.centre);
  const RelativePose relative{found.frame.cam_from_world * Inverse(place.cam_from_world),
                              place.unit};
  velocity_.reset();
  spread_.reset();
  newest_keyframe_ = snapshot.centre;
  frames_since_keyframe_ = 0;
  last_ = Tracked{{found.frame, found.association}, {snapshot.centre, relative}, {}};
}

TrackingResult Tracker::Follow(Frame frame,
                               const MapSnapshot& snapshot,
                               const LiveConditions& live) {
  ++frames_since_keyframe_;
  FollowAnchor(snapshot);
  const Rigid3 last_pose = last_->frame.cam_from_world;
  const double seconds = 1e-9 * static_cast<double>(frame.stamp_ns - last_->frame.stamp_ns);
  const MapSnapshot* seen = &snapshot;
  Finding found = Find(frame, Predict(last_pose, seconds), snapshot);
  if (found.failure != TrackingFailure::kNone && live.earlier != nullptr) {
    Finding again = FindAgain(frame, *live.earlier);
    if (again.failure == TrackingFailure::kNone) {
      found = std::move(again);
      seen = live.earlier;
    }
  }
  const bool scores = !use_ || !use_->read_only;
  if (found.attempt && scores) Score(found.attempt->expected, found.attempt->association);
  if (found.failure != TrackingFailure::kNone) {
    return Fail(std::move(frame), found.failure, found.counts);
  }
  const PoseEstimate& pose = found.attempt->pose;
  velocity_ = LogSe3(pose.cam_from_world * Inverse(last_pose)) / seconds;
  spread_ = Spread{pose.information.inverse(), pose.scene_depth};
  return Succeed(
      std::move(frame), std::move(*found.attempt), found.counts, *seen, live.feature_share);
}

Tracker::Finding Tracker::Find(const Frame& frame,
                               const PosePrior& predicted,
                               const MapSnapshot& snapshot) const {
  FrameCounts counts;
  std::optional<PoseAttempt> attempt = FindPose(frame, predicted, snapshot, counts);
  return Judge(std::move(attempt), counts);
}

Tracker::Finding Tracker::FindAgain(const Frame& frame, const MapSnapshot& earlier) const {
  FrameCounts counts;
  FrameAssociation found;
  const auto first = search_.FromAppearance(frame, *last_, earlier, found, counts);
  if (!first) return Judge(std::nullopt, counts);
  const PosePrior free{last_->frame.cam_from_world};
  PoseAttempt attempt = Settle(frame, *first, free, earlier, std::move(found));
  counts = attempt.counts;
  return Judge(std::move(attempt), counts);
}

Tracker::Finding Tracker::Judge(std::optional<PoseAttempt> attempt, FrameCounts counts) const {
  if (!attempt) {
    const int matches = counts.matched_points + counts.matched_lines;
    return {std::nullopt,
            matches < kFewestUnpredictedInliers ? TrackingFailure::kTooFewMatches
                                                : TrackingFailure::kTooFewInliers,
            counts};
  }
  const PoseEstimate& pose = attempt->pose;
  counts.inlier_points = pose.inlier_points;
  counts.inlier_lines = pose.inlier_lines;
  TrackingFailure failure = TrackingFailure::kNone;
  if (pose.Inliers() < kFewestInliers || !search_.Agreed(pose, counts)) {
    failure = TrackingFailure::kTooFewInliers;
  } else if (!search_.Accepted(pose)) {
    failure = TrackingFailure::kPoseNotObservable;
  }
  return {std::move(attempt), failure, counts};
}

TrackingResult Tracker::Succeed(Frame frame,
                                PoseAttempt attempt,
                                const FrameCounts& counts,
                                const MapSnapshot& snapshot,
                                double feature_share) {
  FrameAssociation& association = attempt.association;
  frame.cam_from_world = attempt.pose.cam_from_world;
  frame.points = IdsOfMatches<PointId>(association.matches.point_of_feature, association.points);
  frame.lines = IdsOfMatches<LineId>(association.matches.line_of_feature, association.lines);
  lost_frames_ = 0;
  state_ = NextState(state_, true, 0, options_.new_map_after);
  TrackingResult result;
  result.counts = counts;
  result.state = state_;
  result.cam_from_world = frame.cam_from_world;
  result.reference = snapshot.centre;
  const Placement& centre = snapshot.places.at(snapshot.centre);
  result.from_reference = {frame.cam_from_world * Inverse(centre.cam_from_world), centre.unit};
  Anchor parent;
  const bool wanted = WantsKeyFrame(frame, association, snapshot, feature_share);
  if (wanted && use_ && use_->read_only) {
    result.leaves_surroundings = true;
    frames_since_keyframe_ = 0;
  } else if (wanted) {
    parent = {snapshot.centre, result.from_reference};
    result.keyframe = MakeKeyFrame(frame, snapshot.centre, result.from_reference);
    result.reference = newest_keyframe_;
    result.from_reference = {Rigid3{}, centre.unit};
  }
  result.frame = frame;
  last_ = Tracked{{std::move(frame), std::move(association)},
                  {result.reference, result.from_reference},
                  parent};
  return result;
}

bool Tracker::WantsKeyFrame(const Frame& frame,
                            const FrameAssociation& association,
                            const MapSnapshot& snapshot,
                            double feature_share) const {
  if (options_.reference == TrackingReference::kLastFrame) return false;  // odometry has no map
  const KeyFrameSituation situation = Situation(frame, association, snapshot, feature_share);
  return DecideKeyFrame(situation, options_.keyframes) != KeyFrameReason::kNone;
}

// From where the frame is predicted. From appearance, too, where that fails, or the motion is not
// known (a guess of no motion finds what happens to lie there), or much less is found than in the
// frame before (an unexpected motion).
std::optional<PoseAttempt> Tracker::FindPose(const Frame& frame,
                                             const PosePrior& predicted,
                                             const MapSnapshot& snapshot,
                                             FrameCounts& counts) const {
  std::optional<PoseAttempt> best;
  FrameAssociation found;
  if (const auto first = search_.FromPrediction(frame, predicted, *last_, snapshot, found)) {
    best = Settle(frame, *first, predicted, snapshot, std::move(found));
  }
  if (!best || !velocity_ || IsWeak(*best)) {
    const PosePrior free{last_->frame.cam_from_world};
    const auto first = search_.FromAppearance(frame, *last_, snapshot, found, counts);
    if (first) {
      PoseAttempt other = Settle(frame, *first, free, snapshot, std::move(found));
      if (!best || ShowsMore(other.association, best->association)) best = std::move(other);
    }
  }
  if (best) counts = best->counts;
  return best;
}

bool Tracker::IsWeak(const PoseAttempt& attempt) const {
  constexpr double kMuchLess = 0.5;
  return !search_.Agreed(attempt.pose, attempt.counts) ||
         attempt.association.matches.All() < kMuchLess * last_->association.matches.All();
}

// With all that the map, or the last frame, has for the frame.
PoseAttempt Tracker::Settle(const Frame& frame,
                            const PoseEstimate& first,
                            const PosePrior& prior,
                            const MapSnapshot& snapshot,
                            FrameAssociation found) const {
  return options_.reference == TrackingReference::kLastFrame
             ? search_.WithLastFrame(frame, first, prior, std::move(found))
             : search_.WithLocalMap(frame, first, prior, snapshot, found);
}

// Moves the last frame with its keyframe by what mapping has done to it since.
void Tracker::FollowAnchor(const MapSnapshot& snapshot) {
  const bool arrived = snapshot.places.contains(last_->anchor.keyframe);
  Anchor& anchor = arrived ? last_->anchor : last_->parent;
  const auto place = snapshot.places.find(anchor.keyframe);
  if (place == snapshot.places.end()) return;  // the first keyframe of a map, on its way
  last_->frame.cam_from_world = PoseBeside(place->second, anchor.relative);
  const double scale = place->second.unit / anchor.relative.unit;
  if (scale == 1) return;
  for (Anchor* each : {&last_->anchor, &last_->parent}) {
    each->relative = {InUnit(each->relative, scale * each->relative.unit),
                      scale * each->relative.unit};
  }
  ChangeUnit(scale);
}

// Takes what is known of the motion into a unit in which lengths are `scale` times what they were.
void Tracker::ChangeUnit(double scale) {
  if (velocity_) velocity_->tail<3>() *= scale;
  if (!spread_) return;
  spread_->covariance.bottomRows<3>() *= scale;
  spread_->covariance.rightCols<3>() *= scale;
  spread_->scene_depth *= scale;
}

// Constant velocity; it may change by kMotionSigma a second, the translation in the unit of the
// scene's depth. The last pose adds its own covariance.
PosePrior Tracker::Predict(const Rigid3& last_pose, double seconds) const {
  PosePrior prior{velocity_ ? RetractLeft(last_pose, seconds * *velocity_) : last_pose};
  if (!spread_) return prior;
  Vector6d sigma = Vector6d::Constant(kMotionSigma * seconds * seconds);
  sigma.tail<3>() *= spread_->scene_depth;
  Matrix6d covariance = spread_->covariance;
  covariance.diagonal() += sigma.cwiseAbs2();
  prior.information = covariance.inverse();
  return prior;
}

void Tracker::Score(const ExpectedLandmarks& expected, const FrameAssociation& association) {
  ScoreKind(
      expected.points, association.matches.point_of_feature, association.points, scores_.points);
  ScoreKind(expected.lines, association.matches.line_of_feature, association.lines, scores_.lines);
}

KeyFrameSituation Tracker::Situation(const Frame& frame,
                                     const FrameAssociation& association,
                                     const MapSnapshot& snapshot,
                                     double feature_share) const {
  KeyFrameSituation situation;
  situation.monocular = monocular_;
  situation.frames_since_keyframe = static_cast<int>(frames_since_keyframe_);
  const Frame& reference = snapshot.reference->frame;
  if (feature_share < 1) {
    const auto features = [](const Frame& f) {
      return static_cast<double>(f.points.size() + f.lines.size());
    };
    situation.share_of_usual = feature_share;
    situation.share_of_reference =
        std::min(1.0, features(frame) / std::max(1.0, features(reference)));
  }
  const int needed = std::min(situation.monocular ? kWellObservedByOne : kWellObserved,
                              static_cast<int>(snapshot.cam_from_world.size()));
  CountShared(reference.points, frame.points, snapshot, needed, situation);
  CountShared(reference.lines, frame.lines, snapshot, needed, situation);
  const auto& disparities = frame.features().point_disparity;
  for (std::size_t i = 0; i < disparities.size(); ++i) {
    if (!disparities[i] || disparities[i]->sigma_px > kCloseDepthSigma * disparities[i]->px) {
      continue;
    }
    const bool tracked = association.matches.point_of_feature[i] >= 0 && frame.points[i].valid();
    ++(tracked ? situation.close_tracked : situation.close_untracked);
  }
  return situation;
}

TrackingResult Tracker::Fail(Frame frame, TrackingFailure failure, FrameCounts counts) {
  ++lost_frames_;
  // A map that loses the camera right after its start was a bad one more often than not.
  const bool trial = trial_keyframes_ > 0;
  const double lost_seconds =
      last_ ? 1e-9 * static_cast<double>(frame.stamp_ns - last_->frame.stamp_ns) : 0;
  const bool wait = use_ ? use_->read_only : !trial && lost_seconds < min_lost_seconds_;
  const int usual = use_ ? use_->patience : options_.new_map_after;
  const int patience = wait ? lost_frames_ + 1 : trial ? 1 : usual;
  state_ = NextState(state_, false, lost_frames_, patience);
  velocity_.reset();
  spread_.reset();
  TrackingResult result;
  result.state = state_;
  result.failure = failure;
  result.counts = counts;
  result.frame = std::move(frame);
  return result;
}

void Tracker::Rehang(KeyFrameId gone, KeyFrameId parent, const RelativePose& gone_from_parent) {
  if (!last_ || last_->anchor.keyframe != gone) return;
  last_->anchor = {parent, Chained(last_->anchor.relative, gone_from_parent)};
}

NewKeyFrame Tracker::MakeKeyFrame(const Frame& frame,
                                  KeyFrameId parent,
                                  const RelativePose& from_parent) {
  newest_keyframe_ = next_keyframe_;
  next_keyframe_ = KeyFrameId{next_keyframe_.value + 1};
  frames_since_keyframe_ = 0;
  if (trial_keyframes_ > 0) --trial_keyframes_;
  return {{newest_keyframe_, parent, frame}, std::exchange(scores_, {}), from_parent};
}

}  // namespace plumbline
