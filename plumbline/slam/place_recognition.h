// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/loop/loop_closer.h"
#include "plumbline/map/atlas.h"
#include "plumbline/place/place_index.h"
#include "plumbline/slam/map_events.h"
#include "plumbline/tracking/options.h"
#include "plumbline/tracking/relocalization.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace plumbline {

// Is told of a keyframe that was compared with the newest one, before the maps change: what became
// of it. An attempt without a refusal closes a loop, or joins the maps of the two.
using PlaceObserver = std::function<void(const Atlas&, const LoopAttempt&)>;

// Knows what the keyframes of all maps show, and makes one place of what was seen twice: closes
// loops within the map that grows, and joins it with another map of the atlas that shows the same.
//
// Deterministic; for one thread.
class PlaceRecognition {
 public:
  PlaceRecognition(const ImagingModel& imaging, const LoopOptions& options);

  // Learns what keyframes have come into the maps since the last call, and forgets those that left.
  void Follow(const Atlas& atlas);

  // Where an image may have been taken: the keyframes of all maps that show what it shows, most
  // alike first, but those of maps that were withdrawn. Valid as long as the maps are.
  std::vector<PlaceToTry> PlacesOf(const Atlas& atlas,
                                   const Features& features,
                                   std::size_t most) const;

  // Whether the active map, young and of one camera, shows with this keyframe that its unit runs
  // away (FindScaleConflict): among its first kYoungKeyFrames keyframes this looks at the three
  // older ones that look most alike. A map of which it is so is withdrawn: nothing is joined with
  // it.
  static constexpr std::int64_t kYoungKeyFrames = 30;
  bool Withdraws(const Atlas& atlas, KeyFrameId id);
  bool IsWithdrawn(MapId map) const { return withdrawn_.contains(map); }

  // A keyframe of the active map, which Follow() has seen. Returns the older keyframe that it was
  // recognized by, where that changed maps at large: then the landmarks of both are fused, and both
  // are in the active map, which may be another one than before. Adjustment is the caller's.
  std::optional<KeyFrameId> Recognize(Atlas& atlas, KeyFrameId id);

  void Observe(PlaceObserver observer) { observer_ = std::move(observer); }

  const std::vector<Recognition>& loops() const { return loops_; }
  const std::vector<MapJoin>& joins() const { return joins_; }

  // What it goes on from beside the maps, which Follow() is to see.
  struct State {
    LoopCloser::State closer;
    std::vector<Recognition> loops;
    std::vector<MapJoin> joins;
    std::set<MapId> withdrawn;

    template <class Self, class Visitor>
    static void VisitState(Self& self, const Visitor& visit) {
      visit(self.closer, self.loops, self.joins, self.withdrawn);
    }
  };
  State state() const { return {closer_.state(), loops_, joins_, withdrawn_}; }
  void SetState(const State& state) {
    closer_.SetState(state.closer);
    loops_ = state.loops;
    joins_ = state.joins;
    withdrawn_ = state.withdrawn;
  }

 private:
  std::vector<KeyFrameId> Candidates(const Atlas& atlas, const KeyFrame& keyframe) const;
  std::optional<KeyFrameId> CloseLoop(Atlas& atlas,
                                      KeyFrameId id,
                                      const std::vector<KeyFrameId>& candidates);
  std::optional<KeyFrameId> Join(Atlas& atlas,
                                 KeyFrameId id,
                                 const std::vector<KeyFrameId>& candidates);

  void Tell(const Atlas& atlas, const LoopAttempt& attempt) const {
    if (observer_) observer_(atlas, attempt);
  }

  ImagingModel imaging_;
  LoopOptions options_;
  PlaceObserver observer_;
  PlaceIndex places_;
  LoopCloser closer_;
  std::vector<Recognition> loops_;
  std::vector<MapJoin> joins_;
  std::set<MapId> withdrawn_;
};

}  // namespace plumbline
