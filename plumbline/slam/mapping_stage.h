// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/projection_search.h"
#include "plumbline/map/map.h"
#include "plumbline/map/snapshot.h"
#include "plumbline/mapping/local_mapper.h"
#include "plumbline/slam/options.h"
#include "plumbline/tracking/tracker.h"

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

namespace plumbline {

// The owner and only writer of the maps. Takes keyframes from the tracker and hands out snapshots.
//
// When a keyframe takes effect is part of the algorithm, not of the machine's speed: one made at
// frame f is in the snapshot from frame f + 1 + lag on, the first one of a map at once. Here the
// work is done when the snapshot is asked for, in the caller's thread.
class MappingStage {
 public:
  MappingStage(const ImagingModel& imaging, const SlamOptions& options);

  // Opens a new map when `starts_map`; frames count from 0.
  void Submit(std::int64_t frame, NewKeyFrame keyframe, bool starts_map);

  // The map around its newest keyframe as frame `frame` may know it; null before the first
  // keyframe.
  std::shared_ptr<const MapSnapshot> SnapshotFor(std::int64_t frame);

  // Does all work that is left.
  void Finish();

  // Empty before the first keyframe; the last one is the map in use.
  const std::vector<Map>& maps() const { return maps_; }

  // Time of the mapping steps done since the last call.
  std::vector<MappingStep> TakeTimes();

 private:
  struct Pending {
    std::int64_t frame = 0;
    NewKeyFrame keyframe;
  };

  void Process(const NewKeyFrame& keyframe);

  LocalMapper mapper_;
  std::int64_t lag_;
  std::vector<Map> maps_;
  std::deque<Pending> pending_;
  std::shared_ptr<const MapSnapshot> snapshot_;
  std::vector<MappingStep> times_;
};

}  // namespace plumbline
