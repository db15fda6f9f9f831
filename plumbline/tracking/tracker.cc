// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/tracker.h"

#include "plumbline/base/error.h"
#include "plumbline/geometry/measured_depth.h"
#include "plumbline/tracking/keyframe_decision.h"

#include <algorithm>
#include <utility>

namespace plumbline {
namespace {

// If the last pose is known to these deviations (PoseUncertainty), lines of the left image alone
// are enough for the next one.
constexpr double kEnoughForLeftLines = 3e-4;

// Returns true if association a is to be preferred: the one that shows more of the map, unless the
// other shows twice as much in all. Things that move have many landmarks made on the spot, but
// after a fast motion little of the map is left in the image.
bool ShowsMore(const LandmarkMatches& a, const LandmarkMatches& b) {
  const int all_a = a.matches.All();
  const int all_b = b.matches.All();
  const int map_a = MatchesOfMap(a);
  const int map_b = MatchesOfMap(b);
  const bool no_map = map_a + map_b == 0;  // odometry has no map
  if (no_map || all_a > 2 * all_b || all_b > 2 * all_a) return all_a > all_b;
  return map_a > map_b;
}

// Returns the attempt to be preferred (ShowsMore), if there is one.
std::optional<PoseAttempt> Better(std::optional<PoseAttempt> predicted,
                                  std::optional<PoseAttempt> other) {
  if (!predicted) return other;
  return other && ShowsMore(other->association, predicted->association) ? std::move(other)
                                                                        : std::move(predicted);
}

}  // namespace

TrackerState NextState(TrackerState state, bool has_pose, int lost_frames, int new_map_after) {
  if (has_pose) return TrackerState::kTracking;
  if (state == TrackerState::kInitializing) return TrackerState::kInitializing;
  return lost_frames >= new_map_after ? TrackerState::kInitializing : TrackerState::kLost;
}

Tracker::Tracker(const CameraAndPyramid& imaging,
                 const TrackingOptions& options,
                 const PoseEstimator& estimator,
                 const Rigid3& world_from_first_cam,
                 const LossPatience& loss)
    : options_(options),
      search_(imaging, options, estimator),
      focal_(imaging.camera.fx),
      monocular_(!MeasuresDepth(imaging.camera)),
      first_cam_from_world_(Inverse(world_from_first_cam)),
      loss_(loss) {}

TrackingResult Tracker::Track(FrameId id,
                              std::int64_t stamp_ns,
                              std::shared_ptr<const FrameFeatures> indexed,
                              const MapSnapshot* snapshot,
                              double feature_share) {
  Frame frame;
  frame.id = id;
  frame.stamp_ns = stamp_ns;
  frame.points.resize(indexed->features.points.size());
  frame.lines.resize(indexed->features.lines.size());
  frame.indexed =
      snapshot != nullptr ? WithCorrection(indexed, snapshot->correction) : std::move(indexed);
  if (state_ == TrackerState::kInitializing) return StartMap(std::move(frame));
  if (!last_) return FinishLost(std::move(frame), TrackingFailure::kNotRelocalized, {});
  PLUMBLINE_CHECK(snapshot != nullptr, "tracking without a map");
  if (snapshot->withdrawn) {
    // A map that was withdrawn counts as one that failed its trial, so that a new one may begin.
    trial_keyframes_ = std::max(trial_keyframes_, 1);
    return FinishLost(std::move(frame), TrackingFailure::kMapWithdrawn, {});
  }
  return TrackInMap(std::move(frame), *snapshot, feature_share);
}

TrackingResult Tracker::TrackInMap(Frame frame, const MapSnapshot& map, double feature_share) {
  ++frames_since_keyframe_;
  UpdateLastFrame(map);  // mapping may have moved its reference keyframe
  const Rigid3 last_pose = last_->frame.cam_from_world;
  const double seconds = 1e-9 * static_cast<double>(frame.stamp_ns - last_->frame.stamp_ns);
  const Prediction predicted = Predict(last_pose, frame.stamp_ns, seconds);

  FrameCounts counts;  // matches by descriptors
  std::optional<PoseAttempt> best = TrackWithMotionModel(frame, predicted, map);
  // Without a known motion the prediction finds whatever happens to lie there. Where much less is
  // found than in the frame before, the motion was unexpected.
  if (!best || !motion_.IsKnown() || state_ == TrackerState::kLost || IsWeak(*best)) {
    best = Better(std::move(best), TrackReferenceKeyFrame(frame, map, counts));
  }
  PoseCandidate pose = CheckPose(std::move(best), counts);
  // A gyroscope that does not belong to the images must not lose what these alone would find.
  if (pose.failure != TrackingFailure::kNone && predicted.turn && gyroscope_->agrees()) {
    Prediction by_images;
    by_images.prior = motion_.Predict(last_pose, seconds);
    auto alone = TrackWithMotionModel(frame, by_images, map);
    if (alone) alone->predicted = false;
    PoseCandidate other = CheckPose(std::move(alone), counts);
    if (other.failure == TrackingFailure::kNone) pose = std::move(other);
  }
  const bool map_learns = !use_ || !use_->read_only;
  if (pose.attempt && map_learns) {
    CountSeen(pose.attempt->expected, pose.attempt->association, scores_);
  }
  if (pose.failure != TrackingFailure::kNone) {
    return FinishLost(std::move(frame), pose.failure, pose.counts);
  }
  frame.cam_from_world = pose.attempt->pose.cam_from_world;
  SetLandmarks(pose.attempt->association, frame);
  const auto last_covariance = motion_.LastCovariance();
  const Matrix6d covariance = motion_.Observe(last_pose, pose.attempt->pose, seconds);
  Teach(predicted, last_pose, last_covariance, *pose.attempt, seconds);
  const bool needs_keyframe = NeedsKeyFrame(frame, pose.attempt->association, map, feature_share);
  TrackingResult result = FinishTracked(std::move(frame), std::move(pose), map, needs_keyframe);
  result.covariance = covariance;
  return result;
}

// The gyroscope tells the turn also over lost frames; without it the motion is unknown after them.
Tracker::Prediction Tracker::Predict(const Rigid3& last_pose,
                                     std::int64_t stamp_ns,
                                     double seconds) {
  constexpr double kDeviations = 2, kNarrowest = 0.5;
  Prediction predicted;
  if (gyroscope_ != nullptr) {
    predicted.turn = gyroscope_->Turn(last_->frame.stamp_ns, stamp_ns);
    if (predicted.turn && gyroscope_->agrees()) {
      const TurnedPrediction turned = motion_.PredictTurned(last_pose, seconds, *predicted.turn);
      predicted.prior = turned.prior;
      predicted.covariance = turned.covariance;
      if (turned.covariance) {
        const double usual_px = FirstSearch().point_radius_px;
        predicted.window = std::clamp(
            kDeviations * focal_ * turned.direction_sigma / usual_px, kNarrowest, kWideFactor);
      }
      return predicted;
    }
    if (state_ == TrackerState::kLost) motion_.Forget();
  }
  predicted.prior = motion_.Predict(last_pose, seconds);
  return predicted;
}

void Tracker::Teach(const Prediction& predicted,
                    const Rigid3& last_pose,
                    const std::optional<Matrix6d>& last_covariance,
                    const PoseAttempt& attempt,
                    double seconds) {
  if (!predicted.turn || !last_covariance) return;
  const Eigen::Matrix3d estimated = attempt.pose.information.inverse().topLeftCorner<3, 3>();
  const Rigid3& pose = attempt.pose.cam_from_world;
  if (predicted.covariance && attempt.predicted) {
    const Eigen::Quaterniond expected = predicted.prior.cam_from_world.rotation;
    gyroscope_->ObserveChange(*predicted.turn,
                              predicted.covariance->topLeftCorner<3, 3>(),
                              LogSo3(pose.rotation * expected.conjugate()),
                              estimated,
                              seconds);
    return;
  }
  const Eigen::Matrix3d R = predicted.turn->b_from_a.toRotationMatrix();
  gyroscope_->Observe(*predicted.turn,
                      pose.rotation * last_pose.rotation.conjugate(),
                      estimated + R * last_covariance->topLeftCorner<3, 3>() * R.transpose(),
                      seconds);
}

std::optional<PoseAttempt> Tracker::TrackWithMotionModel(const Frame& frame,
                                                         const Prediction& predicted,
                                                         const MapSnapshot& snapshot) const {
  LandmarkMatches found;
  const auto first =
      search_.FromPrediction(frame, predicted.prior, *last_, snapshot, found, predicted.window);
  if (!first) return std::nullopt;
  PoseAttempt attempt = TrackLocalMap(frame, *first, predicted.prior, snapshot, std::move(found));
  attempt.predicted = true;
  return attempt;
}

std::optional<PoseAttempt> Tracker::TrackReferenceKeyFrame(const Frame& frame,
                                                           const MapSnapshot& snapshot,
                                                           FrameCounts& counts) const {
  LandmarkMatches found;
  const auto first = search_.FromAppearance(frame, *last_, snapshot, found, counts);
  if (!first) return std::nullopt;
  const PosePrior free{last_->frame.cam_from_world};
  return TrackLocalMap(frame, *first, free, snapshot, std::move(found));
}

// Estimates the final pose from all that the map, or in odometry the last frame, has in the image.
PoseAttempt Tracker::TrackLocalMap(const Frame& frame,
                                   const PoseEstimate& first,
                                   const PosePrior& prior,
                                   const MapSnapshot& snapshot,
                                   LandmarkMatches found) const {
  if (IsOdometry()) return search_.WithLastFrame(frame, first, prior, std::move(found));
  PoseAttempt near = search_.WithLocalMap(frame, first, prior, snapshot, found, {});
  if (first.Inliers() >= options_.enough_inliers) return near;
  // A pose from few landmarks is not exact enough for narrow windows: most of the map would lie
  // outside of them, and the few things inside would confirm the error.
  PoseAttempt wide =
      search_.WithLocalMap(frame, first, prior, snapshot, found, FirstSearch(kWideFactor));
  return wide.pose.Inliers() > near.pose.Inliers() ? wide : near;
}

bool Tracker::IsWeak(const PoseAttempt& attempt) const {
  constexpr double kMuchLess = 0.5;
  return !search_.Agreed(attempt.pose, attempt.counts) ||
         attempt.association.matches.All() < kMuchLess * last_->association.matches.All();
}

Tracker::PoseCandidate Tracker::CheckPose(std::optional<PoseAttempt> attempt,
                                          const FrameCounts& without_pose) const {
  if (!attempt) {
    const int matches = without_pose.matched_points + without_pose.matched_lines;
    return {std::nullopt,
            matches < kFewestUnpredictedInliers ? TrackingFailure::kTooFewMatches
                                                : TrackingFailure::kTooFewInliers,
            without_pose};
  }
  const PoseEstimate& pose = attempt->pose;
  FrameCounts counts = attempt->counts;
  counts.inlier_points = pose.inlier_points;
  counts.inlier_lines = pose.inlier_lines;
  counts.cut_lines = pose.cut_lines;
  TrackingFailure failure = TrackingFailure::kNone;
  if (pose.Inliers() < kFewestInliers || !search_.Agreed(pose, counts)) {
    failure = TrackingFailure::kTooFewInliers;
  } else if (!search_.Accepted(pose)) {
    failure = TrackingFailure::kPoseNotObservable;
  }
  return {std::move(attempt), failure, counts};
}

bool Tracker::NeedsKeyFrame(const Frame& frame,
                            const LandmarkMatches& association,
                            const MapSnapshot& snapshot,
                            double feature_share) const {
  if (IsOdometry()) return false;  // odometry has no map that keyframes could be added to
  const KeyFrameSituation situation = SituationOf(frame,
                                                  association,
                                                  snapshot,
                                                  static_cast<int>(frames_since_keyframe_),
                                                  feature_share,
                                                  monocular_);
  return DecideKeyFrame(situation, options_.keyframes) != KeyFrameReason::kNone;
}

TrackingResult Tracker::FinishTracked(Frame frame,
                                      PoseCandidate pose,
                                      const MapSnapshot& map,
                                      bool needs_keyframe) {
  const KeyFramePose& reference = map.places.at(map.centre);
  ForgetLoss();
  state_ = NextState(state_, true, 0, options_.new_map_after);
  TrackingResult result;
  result.counts = pose.counts;
  result.state = state_;
  result.cam_from_world = frame.cam_from_world;
  result.reference = map.centre;
  result.from_reference = {frame.cam_from_world * Inverse(reference.cam_from_world),
                           reference.scale};
  Anchor parent;
  if (needs_keyframe && use_ && use_->read_only) {
    result.leaves_surroundings = true;
    frames_since_keyframe_ = 0;
  } else if (needs_keyframe) {
    parent = {map.centre, result.from_reference};
    result.keyframe = MakeKeyFrame(frame, map.centre, result.from_reference);
    result.reference = newest_keyframe_;
    result.from_reference = {Rigid3{}, reference.scale};
  }
  result.frame = frame;
  last_ = Tracked{{std::move(frame), std::move(pose.attempt->association)},
                  {result.reference, result.from_reference},
                  parent};
  return result;
}

TrackingResult Tracker::FinishLost(Frame frame, TrackingFailure failure, FrameCounts counts) {
  const bool blind = state_ != TrackerState::kInitializing &&
                     failure != TrackingFailure::kMapWithdrawn && IsBlind(frame.features());
  if (blind) {
    failure = TrackingFailure::kTooFewFeatures;
    asked_ = false;
  }
  // A frame that shows nothing is no evidence against the map.
  ++(blind && blind_frames_ < loss_.blind_frames ? blind_frames_ : lost_frames_);
  state_ = NextState(state_, false, lost_frames_, Patience(frame, blind));
  if (gyroscope_ == nullptr) motion_.Forget();
  TrackingResult result;
  result.state = state_;
  result.failure = failure;
  result.counts = counts;
  result.frame = std::move(frame);
  return result;
}

void Tracker::ForgetLoss() {
  lost_frames_ = 0;
  blind_frames_ = 0;
  asked_ = false;
}

// Returns true if a frame shows too little for the pose of a lost camera. If depth is measured,
// points without depth do not count, since no map can start with them and noise has many.
bool Tracker::IsBlind(const Features& features) const {
  const std::size_t seen = features.points.size() + features.lines.size();
  const auto depths = std::ssize(features.point_disparity.values()) + std::ssize(features.lines);
  const std::int64_t counted = monocular_ ? static_cast<std::int64_t>(seen) : depths;
  return counted < kFewestUnpredictedInliers;
}

// Returns the number of lost frames after which another map starts.
int Tracker::Patience(const Frame& frame, bool blind) const {
  // A map that loses the camera right after its start was usually a bad one.
  const bool trial = trial_keyframes_ > 0;
  const double lost_seconds =
      last_ ? 1e-9 * static_cast<double>(frame.stamp_ns - last_->frame.stamp_ns) : 0;
  const bool unasked = blind_frames_ > 0 && (blind || !asked_);
  const bool wait =
      unasked || (use_ ? use_->read_only : !trial && lost_seconds < loss_.min_seconds);
  if (wait) return lost_frames_ + 1;
  const int usual = use_ ? use_->patience : options_.new_map_after;
  return trial ? 1 : usual;
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

// Moves the last frame with its keyframe by the changes of mapping since then.
void Tracker::UpdateLastFrame(const MapSnapshot& snapshot) {
  const bool arrived = snapshot.places.contains(last_->anchor.keyframe);
  Anchor& anchor = arrived ? last_->anchor : last_->parent;
  const auto place = snapshot.places.find(anchor.keyframe);
  if (place == snapshot.places.end()) return;  // a first keyframe is not in the map yet
  last_->frame.cam_from_world = ComposePose(place->second, anchor.relative);
  const double scale = place->second.scale / anchor.relative.scale;
  if (scale == 1) return;
  for (Anchor* each : {&last_->anchor, &last_->parent}) {
    each->relative = {Rescaled(each->relative, scale * each->relative.scale),
                      scale * each->relative.scale};
  }
  motion_.ChangeUnit(scale);
}

TrackingResult Tracker::StartMap(Frame frame) {
  const Features& features = frame.features();
  const auto with_depth =
      std::ssize(features.point_disparity.values()) + std::ssize(features.line_right.values());
  if (with_depth < options_.min_initial) {
    return FinishLost(std::move(frame), TrackingFailure::kTooFewFeatures, {});
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
  ForgetLoss();
  motion_.Forget();
  const std::size_t points = frame.points.size();
  const std::size_t lines = frame.lines.size();
  last_ = Tracked{{std::move(frame), LandmarkMatches(points, lines)}, {newest_keyframe_, {}}, {}};
  return result;
}

bool Tracker::NeedsRightLines() const {
  if (monocular_) return false;
  return state_ != TrackerState::kTracking || IsOdometry() ||
         !motion_.LastPoseIsKnownTo(kEnoughForLeftLines);
}

bool Tracker::WantsRightLines(const TrackingResult& result) const {
  if (monocular_ || IsOdometry() || result.starts_map || !result.cam_from_world) {
    return false;
  }
  return result.keyframe || !motion_.LastPoseIsKnownTo(kEnoughForLeftLines);
}

void Tracker::Complete(const std::shared_ptr<const FrameFeatures>& whole, TrackingResult& result) {
  last_->frame.indexed = whole;
  result.frame.indexed = whole;
  if (result.keyframe) result.keyframe->keyframe.frame.indexed = whole;
}

TrackingResult Tracker::StartFrom(const MapSnapshot& snapshot, const Vector6d& velocity) {
  const Frame& frame = snapshot.reference->frame;
  newest_keyframe_ = snapshot.centre;
  next_keyframe_ = KeyFrameId{newest_keyframe_.value + 1};
  frames_since_keyframe_ = 0;
  use_.reset();
  scores_ = {};
  ForgetLoss();
  trial_keyframes_ = options_.trial_keyframes;
  motion_.Begin(velocity);
  state_ = NextState(state_, true, 0, options_.new_map_after);
  LandmarkMatches association = AssociationOf(frame, snapshot);
  TrackingResult result;
  result.state = state_;
  result.counts.matched_points = result.counts.inlier_points = association.matches.Points();
  result.counts.matched_lines = result.counts.inlier_lines = association.matches.Lines();
  result.cam_from_world = frame.cam_from_world;
  result.reference = newest_keyframe_;
  result.frame = frame;
  result.from_reference.scale = snapshot.reference->scale;
  last_ = Tracked{{frame, std::move(association)}, {newest_keyframe_, result.from_reference}, {}};
  return result;
}

void Tracker::BeginLost(const MapUse& use) {
  state_ = TrackerState::kLost;
  next_keyframe_ = use.next_keyframe;
  use_ = use;
}

void Tracker::FollowFrom(const Relocalized& found, const MapSnapshot& snapshot) {
  const KeyFramePose& place = snapshot.places.at(snapshot.centre);
  const RelativePose relative{found.frame.cam_from_world * Inverse(place.cam_from_world),
                              place.scale};
  motion_.Forget();
  newest_keyframe_ = snapshot.centre;
  frames_since_keyframe_ = 0;
  last_ = Tracked{{found.frame, found.association}, {snapshot.centre, relative}, {}};
}

void Tracker::ReparentPoses(KeyFrameId gone,
                            KeyFrameId parent,
                            const RelativePose& gone_from_parent) {
  if (!last_ || last_->anchor.keyframe != gone) return;
  last_->anchor = {parent, Chained(last_->anchor.relative, gone_from_parent)};
}

}  // namespace plumbline
