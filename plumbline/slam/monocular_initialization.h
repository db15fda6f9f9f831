// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/initialization/initializer.h"
#include "plumbline/map/atlas.h"
#include "plumbline/slam/front_end.h"
#include "plumbline/slam/initial_map_edit.h"
#include "plumbline/slam/options.h"
#include "plumbline/slam/system_methods.h"
#include "plumbline/tracking/pose_search.h"
#include "plumbline/tracking/tracker.h"

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

namespace plumbline {

// An early frame of a map, or from before its start, and its pose in the finished map.
struct EarlierFrame {
  FrameId id;
  MapId map;
  KeyFrameId reference;
  RelativePose from_reference;
  FrameCounts counts;
};

// State of a single camera before it has a reliable map: the initializer, the frames that wait for
// poses until a map starts, and the early frames of each map. The baseline of a recent map is
// short, and its landmarks move considerably afterwards. Poses relative to its keyframes do not
// follow them, and are therefore estimated again.
//
// Stored are the features (about 0.14 MB a frame) of the newest kMaxFrames waiting frames and, for
// every map, of at most kMaxFrames frames tracked until the map has kYoungKeyFrames keyframes more
// than at its start. All of them get their poses after all mapping is done (Locate): the landmarks
// are most accurate then, and no frame is delayed by it.
class MonocularInitialization {
 public:
  static constexpr std::size_t kMaxFrames = 300;
  static constexpr std::size_t kMostKept = 1200;  // of all maps, when another one begins
  static constexpr int kYoungKeyFrames = 5;

  // The helper shares the initializer's work, and must outlive this object.
  MonocularInitialization(const CameraAndPyramid& imaging,
                          const SlamOptions& options,
                          const SystemMethods& methods = {},
                          HelperThread* helper = nullptr);

  // Lets a gyroscope take part in the decision for a start; it must outlive this object.
  void Use(const Gyroscope& gyroscope) { initializer_->Use(gyroscope); }
  InitializationResult Offer(FrameId id, const ExtractedFrame& frame);
  // Counts of the initializer so far.
  const InitializationCounts& counts() const { return initializer_->counts(); }
  // Begins anew: the initializer and the waiting frames are discarded.
  void Restart();
  // Adds a tracked frame. Only frames of a recent map are stored.
  void Tracked(const TrackingResult& result);
  // Handles a dropped keyframe: frames that refer to it refer to its parent from now on.
  void ReparentPoses(KeyFrameId gone, KeyFrameId parent, const RelativePose& gone_from_parent);
  // Handles the start of a map by `start`, to which the waiting frames belong.
  void MapStarted(MapId map, const InitialMapEdit& start);

  // Handles the return to an earlier map.
  void MapLeft();

  // Returns the poses of the stored frames in the maps started since the last call, each map's
  // newest frame first. Waiting frames are searched near the pose predicted by their successors,
  // tracked frames near their old pose, among the landmarks around their reference keyframe.
  // Keyframes are left out, as are frames that are not found, or not reached before `stop`.
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
  // Keyframes still to come until the newest map is no longer recent.
  int young_keyframes_ = 0;
  // Frames that may still be stored until then.
  std::size_t young_frames_ = 0;
};

}  // namespace plumbline
