// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/monocular_initialization.h"

#include "plumbline/image/image.h"
#include "plumbline/initialization/make_initializer.h"
#include "plumbline/map/snapshot.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

namespace plumbline {
namespace {

// Frames missed in a row, after which earlier frames are not searched any more.
constexpr int kMaxMissed = 5;

// Predicts poses back in time from known ones, with constant velocity.
class BackwardPrediction {
 public:
  bool Known() const { return last_.has_value(); }

  Rigid3 At(std::int64_t stamp_ns) const {
    const double seconds = 1e-9 * static_cast<double>(stamp_ns - last_->stamp_ns);
    return RetractLeft(last_->cam_from_world, seconds * velocity_);
  }

  void Add(std::int64_t stamp_ns, const Rigid3& cam_from_world) {
    if (last_) {
      const double seconds = 1e-9 * static_cast<double>(stamp_ns - last_->stamp_ns);
      velocity_ = LogSe3(cam_from_world * Inverse(last_->cam_from_world)) / seconds;
    }
    last_ = Pose{stamp_ns, cam_from_world};
  }

 private:
  struct Pose {
    std::int64_t stamp_ns = 0;
    Rigid3 cam_from_world;
  };
  std::optional<Pose> last_;
  Vector6d velocity_ = Vector6d::Zero();
};

// The keyframe that an earlier frame is searched from, and the landmarks around it.
class NearestKeyFrame {
 public:
  explicit NearestKeyFrame(const Map& map) : map_(map), id_(map.keyframes().begin()->first) {}

  // Moves to a keyframe; does nothing if it has left the map.
  void MoveTo(KeyFrameId id) {
    if (id == id_ || map_.Find(id) == nullptr) return;
    id_ = id;
    snapshot_.reset();
  }

  KeyFrameId id() const { return id_; }
  bool IsMadeOf(FrameId frame) const { return map_.Find(id_)->frame.id == frame; }
  RelativePose Relative(const Rigid3& cam_from_world) const {
    const KeyFramePose place = map_.PlaceOf(id_);
    return {cam_from_world * Inverse(place.cam_from_world), place.scale};
  }
  const MapSnapshot& snapshot() {
    if (!snapshot_) snapshot_ = TakeSnapshot(map_, id_);
    return *snapshot_;
  }

 private:
  const Map& map_;
  KeyFrameId id_;
  std::shared_ptr<const MapSnapshot> snapshot_;
};

}  // namespace

MonocularInitialization::MonocularInitialization(const CameraAndPyramid& imaging,
                                                 const SlamOptions& options,
                                                 const SystemMethods& methods,
                                                 HelperThread* helper)
    : imaging_(imaging),
      max_pose_sigma_(options.tracking.max_pose_sigma),
      estimator_(methods.MakePoseEstimator(imaging.camera, options)),
      initializer_(methods.make_initializer(
          imaging, options.initialization, static_cast<std::uint64_t>(options.slam.seed), helper)) {
}

InitializationResult MonocularInitialization::Offer(FrameId id, const ExtractedFrame& frame) {
  waiting_.push_back({id, frame.stamp_ns, frame.indexed, {}, {}});
  if (waiting_.size() > kMaxFrames) waiting_.pop_front();
  return initializer_->Add(
      {id, frame.stamp_ns, frame.indexed, std::make_shared<const GrayImage>(frame.images.left)});
}

void MonocularInitialization::Restart() {
  initializer_->Reset();
  waiting_.clear();
  young_keyframes_ = 0;
}

void MonocularInitialization::MapStarted(MapId map, const InitialMapEdit& start) {
  for (KeptFrame& frame : waiting_) {
    const auto at = std::find(start.frames.begin(), start.frames.end(), frame.id);
    if (at == start.frames.end()) continue;
    frame.reference = start.keyframes[static_cast<std::size_t>(at - start.frames.begin())];
  }
  starts_.push_back({map, std::exchange(waiting_, {})});
  GiveUpTheOldest();
  young_keyframes_ = kYoungKeyFrames;
  young_frames_ = kMaxFrames;
  initializer_->Reset();
}

// A camera that is lost again and again begins many maps. The frames of the oldest ones are given
// up: those that were tracked keep the pose that they have.
void MonocularInitialization::GiveUpTheOldest() {
  std::size_t kept = 0;
  for (auto start = starts_.rbegin(); start != starts_.rend(); ++start) {
    kept += start->frames.size();
    if (kept <= kMostKept) continue;
    starts_.erase(starts_.begin(), start.base());
    return;
  }
}

void MonocularInitialization::MapLeft() { young_keyframes_ = 0; }

void MonocularInitialization::Tracked(const TrackingResult& result) {
  if (young_keyframes_ == 0 || young_frames_ == 0) return;
  const Frame& frame = result.frame;
  starts_.back().frames.push_back(
      {frame.id, frame.stamp_ns, frame.indexed, result.reference, result.from_reference});
  --young_frames_;
  if (result.keyframe) --young_keyframes_;
}

void MonocularInitialization::ReparentPoses(KeyFrameId gone,
                                            KeyFrameId parent,
                                            const RelativePose& gone_from_parent) {
  if (starts_.empty()) return;
  for (KeptFrame& frame : starts_.back().frames) {
    if (frame.reference != gone) continue;
    frame.reference = parent;
    frame.from_reference = Chained(frame.from_reference, gone_from_parent);
  }
}

std::vector<EarlierFrame> MonocularInitialization::Locate(const Atlas& atlas,
                                                          const StopCheck& stop) {
  std::vector<EarlierFrame> located;
  for (const Start& start : starts_) {
    LocateFramesOf(start, *atlas.Find(atlas.Current(start.map)), stop, located);
  }
  starts_.clear();
  young_keyframes_ = 0;
  return located;
}

void MonocularInitialization::LocateFramesOf(const Start& start,
                                             const Map& map,
                                             const StopCheck& stop,
                                             std::vector<EarlierFrame>& located) const {
  NearestKeyFrame nearest(map);
  BackwardPrediction prediction;
  int missed = 0;
  for (auto frame = start.frames.rbegin(); frame != start.frames.rend(); ++frame) {
    if (IsToStop(stop)) return;
    const bool tracked = frame->reference.valid();
    Rigid3 predicted;
    if (tracked) {
      nearest.MoveTo(frame->reference);
      predicted = ComposePose(map.PlaceOf(frame->reference), frame->from_reference);
      missed = 0;
    } else {
      if (!prediction.Known() || missed >= kMaxMissed) continue;
      predicted = prediction.At(frame->stamp_ns);
    }
    if (nearest.IsMadeOf(frame->id)) {
      prediction.Add(frame->stamp_ns, predicted);
      continue;
    }
    const auto indexed = WithCorrection(frame->indexed, nearest.snapshot().correction);
    const auto found =
        LocateFrame(imaging_, estimator_, *indexed, predicted, nearest.snapshot(), max_pose_sigma_);
    if (!found) {
      if (tracked) prediction.Add(frame->stamp_ns, predicted);
      missed += !tracked;
      continue;
    }
    missed = 0;
    const Rigid3& pose = found->pose.cam_from_world;
    prediction.Add(frame->stamp_ns, pose);
    located.push_back({frame->id, start.map, nearest.id(), nearest.Relative(pose), found->counts});
  }
}

}  // namespace plumbline
