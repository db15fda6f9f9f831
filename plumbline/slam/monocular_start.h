// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/initialization/initializer.h"
#include "plumbline/map/map.h"
#include "plumbline/slam/front_end.h"
#include "plumbline/slam/map_start.h"
#include "plumbline/slam/options.h"
#include "plumbline/tracking/frame_location.h"

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <vector>

namespace plumbline {

// A frame that came before its map, and its place in it.
struct EarlierFrame {
  FrameId id;
  MapId map;
  KeyFrameId reference;
  Rigid3 cam_from_reference;
  FrameCounts counts;
};

// What a single camera needs before it has a map: the initializer, and the frames that wait for
// poses until there is one.
//
// The newest kMaxWaiting frames are kept. They get their poses when all mapping is done (Locate):
// then the landmarks are known best, and no frame takes longer for it.
class MonocularStart {
 public:
  static constexpr std::size_t kMaxWaiting = 300;

  MonocularStart(const ImagingModel& imaging, const SlamOptions& options);

  InitializationResult Offer(FrameId id, const MeasuredFrame& frame);
  // Begins anew, after a loss.
  void Restart();
  // The frames that wait belong to this map, which began so.
  void MapStarted(MapId map, const MapStart& start);

  // Poses of the frames that waited for the maps started since the last call, each map's newest
  // frame first: every frame is searched near the place that its successors predict. Keyframes are
  // left out.
  std::vector<EarlierFrame> Locate(const std::vector<Map>& maps);

 private:
  struct Waiting {
    FrameId id;
    std::int64_t stamp_ns = 0;
    std::shared_ptr<const IndexedFeatures> indexed;
  };
  struct Start {
    MapId map;
    std::map<FrameId, KeyFrameId> keyframes;
    std::deque<Waiting> frames;
  };

  void LocateFramesOf(const Start& start, const Map& map, std::vector<EarlierFrame>& located) const;

  ImagingModel imaging_;
  TrackingOptions tracking_;
  LineWeighting weighting_;
  std::unique_ptr<Initializer> initializer_;
  std::deque<Waiting> waiting_;
  std::vector<Start> starts_;
};

}  // namespace plumbline
