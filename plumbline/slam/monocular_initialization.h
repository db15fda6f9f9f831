// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/initialization/initializer.h"
#include "plumbline/map/atlas.h"
#include "plumbline/slam/front_end.h"
#include "plumbline/slam/initial_map_edit.h"
#include "plumbline/slam/options.h"
#include "plumbline/tracking/frame_location.h"
#include "plumbline/tracking/tracker.h"

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

namespace plumbline {

// A frame from before its map began or from the map's youth, and its place in the finished map.
struct EarlierFrame {
  FrameId id;
  MapId map;
  KeyFrameId reference;
  RelativePose from_reference;
  FrameCounts counts;
};

// What a single camera needs before it has a map that can be trusted: the initializer, the frames
// that wait for poses until there is a map, and the frames that were tracked while the map was
// young. The baseline of a young map is short, and its landmarks move a good deal afterwards. Poses
// relative to its keyframes do not follow them, and are therefore found anew.
//
// Kept are the features (about 0.14 MB a frame) of the newest kMaxFrames frames that wait and, for
// every map, of at most kMaxFrames frames tracked until the map has kYoungKeyFrames keyframes more
// than it began with. All of them get their poses after all mapping is done (Locate): the landmarks
// are known best then, and no frame takes longer for it.
class MonocularInitialization {
 public:
  static constexpr std::size_t kMaxFrames = 300;
  static constexpr std::size_t kMostKept = 1200;  // of all maps, when another one begins
  static constexpr int kYoungKeyFrames = 5;

  // The helper shares the initializer's work, and has to outlive this.
  MonocularInitialization(const CameraAndPyramid& imaging,
                          const SlamOptions& options,
                          HelperThread* helper = nullptr);

  InitializationResult Offer(FrameId id, const ExtractedFrame& frame);
  // What the initializer has done so far.
  const InitializationCounts& counts() const { return initializer_->counts(); }
  // Begins anew: the initializer and the frames that wait are forgotten.
  void Restart();
  // Tells of a frame that was tracked. Only frames of a young map are kept.
  void Tracked(const TrackingResult& result);
  // A keyframe was given up: frames that refer to it refer to its parent from now on.
  void ReparentPoses(KeyFrameId gone, KeyFrameId parent, const RelativePose& gone_from_parent);
  // Tells that a map began with `start`, and that the frames that wait belong to it.
  void MapStarted(MapId map, const InitialMapEdit& start);

  // Tells that what is tracked from now on is in a map of before.
  void MapLeft();

  // Returns the poses of the kept frames in the maps started since the last call, each map's newest
  // frame first. Frames that waited are searched near the place that their successors predict.
  // Frames that were tracked are searched near their old place, among the landmarks around the
  // keyframe that they refer to. Keyframes are left out, as are frames that are not found, or not
  // reached before `stop`.
  std::vector<EarlierFrame> Locate(const Atlas& atlas, const StopCheck& stop = {});

 private:
  struct KeptFrame {
    FrameId id;
    std::int64_t stamp_ns = 0;
    std::shared_ptr<const FrameFeatures> indexed;
    KeyFrameId reference;  // invalid while the frame has no pose
    RelativePose from_reference;
  };
  struct Start {
    MapId map;
    std::deque<KeptFrame> frames;  // in order of time
  };
  void GiveUpTheOldest();
  void LocateFramesOf(const Start& start,
                      const Map& map,
                      const StopCheck& stop,
                      std::vector<EarlierFrame>& located) const;

  CameraAndPyramid imaging_;
  double max_pose_sigma_;  // TrackingOptions::max_pose_sigma
  PoseEstimator estimator_;
  std::unique_ptr<Initializer> initializer_;
  std::deque<KeptFrame> waiting_;
  std::vector<Start> starts_;
  // Keyframes still to come until the newest map is no longer young.
  int young_keyframes_ = 0;
  // Frames that may still be kept until then.
  std::size_t young_frames_ = 0;
};

}  // namespace plumbline
