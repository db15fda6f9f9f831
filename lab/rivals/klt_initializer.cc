// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/rivals/klt_initializer.h"

#include "lab/rivals/start_steps.h"
#include "plumbline/base/error.h"
#include "plumbline/base/ids.h"
#include "plumbline/base/random.h"
#include "plumbline/initialization/initial_map.h"
#include "plumbline/initialization/track_factorization.h"
#include "plumbline/solvers/relative_pose.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace plumbline {
namespace {

constexpr int kMinFeatures = 60;
constexpr int kMinTracks = 50;
constexpr std::size_t kMinPoints = 30;  // fewest points of a map
constexpr std::size_t kMaxFrames = 80;
constexpr double kTrackSigmaPx = 0.5;
constexpr double kMinShareInFront = 0.9;
constexpr double kMaxSpread = 2;  // largest spread of the residuals, in standard deviations
constexpr double kMinParallaxDeg = 1;

struct Poses {
  std::vector<Rigid3> cam_from_reference;  // |translation| = 1
  double parallax_deg = 0;                 // parallax of the newest frame
};

// Returns the best relative pose of each frame by itself; nullopt if a frame has none.
std::optional<Poses> RelativePoses(const FeatureTracks& tracks, Rng& rng) {
  Poses poses;
  for (const ViewPoints& view : tracks.views) {
    const std::vector<RayMatch> matches = MatchesBetween(tracks.reference, view);
    const auto hypotheses = EstimateRelativePoses(matches, {}, rng);
    if (hypotheses.empty()) return std::nullopt;
    const Rigid3& pose = hypotheses.front().b_from_a;
    poses.cam_from_reference.push_back(pose);
    poses.parallax_deg = MedianParallax(matches, pose.rotation) * 180 / std::numbers::pi;
  }
  return poses;
}

std::optional<Rank1Solution> Factorize(const FeatureTracks& tracks, const Poses& poses) {
  std::vector<Rank1View> views;
  for (std::size_t i = 0; i < tracks.views.size(); ++i) {
    views.push_back(Rank1ViewOf(tracks.views[i], poses.cam_from_reference[i]));
  }
  return FactorizeRank1(tracks.reference.points, views);
}

}  // namespace

KltInitializer::KltInitializer(const RectifiedCamera& camera,
                               const InitializationOptions& options,
                               std::uint64_t seed,
                               HelperThread* helper)
    : camera_(camera), frame_count_(options.frames), seed_(seed), helper_(helper) {}

void KltInitializer::Reset() {
  reference_.reset();
  frames_.clear();
}

void KltInitializer::Start(const InitializationFrame& frame) {
  reference_ = frame;
  frames_.clear();
  TrackedPixels points;
  for (const PointFeature& feature : frame.indexed->features.points)
    points.emplace_back(feature.px);
  tracks_ = KltTracks(frame.image, std::move(points));
}

InitializationResult KltInitializer::Add(const InitializationFrame& frame) {
  using enum InitializationStatus;
  PLUMBLINE_CHECK(frame.image != nullptr, "optical flow needs the image");
  const bool enough = static_cast<int>(frame.indexed->features.points.size()) >= kMinFeatures;
  if (!reference_) {
    if (!enough) return {.wait = kTooFewFeatures};
    Start(frame);
    return {.wait = kTooFewFrames};
  }
  tracks_.Follow(frame.image, helper_);
  InitializationResult result;
  if (tracks_.alive() < kMinTracks) {
    if (enough) Start(frame);
    result.wait = kTooFewMatches;
  } else {
    if (frames_.size() == kMaxFrames) frames_.erase(frames_.begin());
    frames_.push_back({frame, tracks_.places()});
    const bool window = static_cast<int>(frames_.size()) >= frame_count_;
    result = window ? Attempt() : InitializationResult{.wait = kTooFewFrames};
  }
  result.matches = tracks_.alive();
  return result;
}

std::vector<int> KltInitializer::SelectFrames() const {
  const int size = static_cast<int>(frames_.size());
  std::vector<int> frames;
  for (int j = 1; j <= frame_count_; ++j) frames.push_back(j * size / frame_count_ - 1);
  return frames;
}

FeatureTracks KltInitializer::CollectTracks(const std::vector<int>& frames) const {
  FeatureTracks tracks;
  tracks.views.resize(frames.size());
  const double sigma = kTrackSigmaPx / camera_.fx;
  const auto add = [&](const Eigen::Vector2d& px, ViewPoints& points) {
    points.points.emplace_back(camera_.Unproject(px).hnormalized());
    points.sigmas.push_back(sigma);
  };
  const std::vector<PointFeature>& features = reference_->indexed->features.points;
  for (std::size_t k = 0; k < features.size(); ++k) {
    if (!tracks_.places()[k]) continue;  // a point that is alive in the last frame is alive in all
    tracks.features.push_back(static_cast<int>(k));
    add(features[k].px, tracks.reference);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      add(*frames_[Index(frames[i])].places[k], tracks.views[i]);
    }
  }
  return tracks;
}

InitializationResult KltInitializer::Attempt() {
  using enum InitializationStatus;
  const std::vector<int> frames = SelectFrames();
  const FeatureTracks tracks = CollectTracks(frames);
  Rng rng(seed_, "initialization", static_cast<std::uint64_t>(frames_.back().frame.id.value));
  const auto poses = RelativePoses(tracks, rng);
  if (!poses) return {.wait = kInaccurate};
  InitializationResult result{.wait = kTooLittleParallax, .parallax_deg = poses->parallax_deg};
  if (poses->parallax_deg < kMinParallaxDeg) return result;
  const auto factors = Factorize(tracks, *poses);
  result.wait = kInaccurate;
  if (!factors || factors->in_front < kMinShareInFront * factors->solved ||
      factors->spread > kMaxSpread) {
    return result;
  }
  std::vector<Rigid3> solved = poses->cam_from_reference;
  for (std::size_t i = 0; i < solved.size(); ++i) {
    solved[i].translation = -(solved[i].rotation * factors->centres[i]);
  }
  result.map = BuildMap(frames, solved);
  if (result.map) result.wait = kNone;
  return result;
}

std::optional<InitialMap> KltInitializer::BuildMap(const std::vector<int>& frames,
                                                   const std::vector<Rigid3>& poses) const {
  std::vector<InitialView> views{{*reference_, Rigid3{}}};
  std::vector<FeatureTrack> by_feature(reference_->indexed->features.points.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Followed& followed = frames_[Index(frames[i])];
    views.push_back({followed.frame, poses[i]});
    const std::vector<int> nearest =
        NearestFeatures(*followed.frame.indexed, followed.places, kAttachRadiusPx);
    for (std::size_t k = 0; k < nearest.size(); ++k) {
      if (nearest[k] < 0 || !tracks_.places()[k]) continue;
      if (by_feature[k].empty()) by_feature[k].push_back({0, static_cast<int>(k)});
      by_feature[k].push_back({static_cast<int>(i) + 1, nearest[k]});
    }
  }
  std::erase_if(by_feature, [](const FeatureTrack& track) { return track.empty(); });
  return TriangulateAndAdjustMap(camera_, std::move(views), by_feature, {}, kMinPoints);
}

}  // namespace plumbline
