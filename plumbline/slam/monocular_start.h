// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/initialization/initializer.h"
#include "plumbline/map/atlas.h"
#include "plumbline/map/state_stream.h"
#include "plumbline/slam/front_end.h"
#include "plumbline/slam/map_start.h"
#include "plumbline/slam/options.h"
#include "plumbline/tracking/frame_location.h"

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

namespace plumbline {

// A frame from before its map or from the map's beginning, and its place in the finished map.
struct EarlierFrame {
  FrameId id;
  MapId map;
  KeyFrameId reference;
  RelativePose from_reference;
  FrameCounts counts;
};

// What a single camera needs before it has a map that can be trusted: the initializer, the frames
// that wait for poses until there is a map, and those that were tracked while the map was young.
// The baseline of a young map is short, and its landmarks move a good deal afterwards: poses
// relative to its keyframes do not follow that.
//
// Kept are the features (about 0.14 MB a frame) of the newest kMaxFrames frames that wait, and of
// those tracked until a map has kYoungKeyFrames keyframes more than it began with, kMaxFrames at
// most; of every map. All get their poses when all mapping is done (Locate): then the landmarks are
// known best, and no frame takes longer for it.
class MonocularStart {
 public:
  static constexpr std::size_t kMaxFrames = 300;
  static constexpr int kYoungKeyFrames = 5;

  MonocularStart(const ImagingModel& imaging, const SlamOptions& options);

  InitializationResult Offer(FrameId id, const MeasuredFrame& frame);
  // Begins anew, after a loss.
  void Restart();
  // Tells of a frame that was tracked; only those of a young map are kept.
  void Tracked(const TrackingResult& result);
  // A keyframe is none any more; what was tracked by it hangs on its parent.
  void Rehang(KeyFrameId gone, KeyFrameId parent, const RelativePose& gone_from_parent);
  // The frames that wait belong to this map, which began so.
  void MapStarted(MapId map, const MapStart& start);

  // What is tracked from now on is in a map of before.
  void MapLeft();

  // Poses in the maps started since the last call, each map's newest frame first. Frames that
  // waited are searched near the place that their successors predict, those that were tracked near
  // their place of then, among the landmarks around the next keyframe and their own. Left out are
  // keyframes, and frames that are not found, or not reached before `stop`.
  std::vector<EarlierFrame> Locate(const Atlas& atlas, const StopCheck& stop = {});

  // Writes down all that it keeps, and takes the place of another one of the same options that did.
  // Load throws InputError for bytes that none wrote, or that tell of keyframes that the maps do
  // not know.
  void Save(StateWriter& archive) const;
  void Load(StateReader& archive, const Atlas& atlas);

 private:
  struct KeptFrame {
    FrameId id;
    std::int64_t stamp_ns = 0;
    std::shared_ptr<const IndexedFeatures> indexed;
    KeyFrameId reference;  // none while the frame has no pose
    RelativePose from_reference;

    template <class Self, class Visitor>
    static void VisitState(Self& self, const Visitor& visit) {
      visit(self.id, self.stamp_ns, self.indexed, self.reference, self.from_reference);
    }
  };
  struct Start {
    MapId map;
    std::deque<KeptFrame> frames;  // by time

    template <class Self, class Visitor>
    static void VisitState(Self& self, const Visitor& visit) {
      visit(self.map, self.frames);
    }
  };

  template <class Self, class Visitor>
  static void VisitFrames(Self& self, const Visitor& visit) {
    visit(self.waiting_, self.starts_, self.young_keyframes_, self.young_frames_);
  }
  void LocateFramesOf(const Start& start,
                      const Map& map,
                      const StopCheck& stop,
                      std::vector<EarlierFrame>& located) const;

  ImagingModel imaging_;
  double max_pose_sigma_;  // TrackingOptions::max_pose_sigma
  PoseEstimator estimator_;
  std::unique_ptr<Initializer> initializer_;
  std::deque<KeptFrame> waiting_;
  std::vector<Start> starts_;
  int young_keyframes_ = 0;       // still to come until the newest map is no longer young
  std::size_t young_frames_ = 0;  // that may still be kept until then
};

}  // namespace plumbline
