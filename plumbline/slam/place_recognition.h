// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/loop_closing/loop_closer.h"
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

// Called with each keyframe that was compared with the newest one and what became of it, before the
// maps change. An attempt without a refusal closes a loop or joins the maps of the two.
using PlaceObserver = std::function<void(const Atlas&, const LoopAttempt&)>;

// Knows what the keyframes of all maps show, and makes one place of what was seen twice. It closes
// loops within the active map, and joins that map with another map of the atlas that shows the same
// place.
//
// Deterministic; for one thread.
class PlaceRecognition {
 public:
  PlaceRecognition(const CameraAndPyramid& imaging, const LoopOptions& options);

  // Learns what keyframes have come into the maps since the last call, and forgets those that left.
  void Follow(const Atlas& atlas);

  // Returns where an image may have been taken: the keyframes of all maps that show what it shows,
  // the most alike first. Maps that were withdrawn are left out. The result is valid as long as the
  // maps are.
  std::vector<PlaceToTry> PlacesOf(const Atlas& atlas,
                                   const Features& features,
                                   std::size_t most) const;

  // Whether a new keyframe shows that the unit of length of the active map runs away
  // (FindScaleConflict). This looks only at maps of one camera, at their first kYoungKeyFrames
  // keyframes, and for each at the three older keyframes that look most alike. If so, the map is
  // withdrawn: no map is joined with it any more.
  static constexpr std::int64_t kYoungKeyFrames = 30;
  bool Withdraws(const Atlas& atlas, KeyFrameId id);
  bool IsWithdrawn(MapId map) const { return withdrawn_.contains(map); }

  // Looks for an older keyframe that shows what a new one of the active map shows; Follow() must
  // have seen the new one. Returns the older keyframe where that changed maps at large. Then the
  // landmarks of both are fused, and both are in the active map, which may be another one than
  // before. The caller has to adjust the map.
  std::optional<KeyFrameId> Recognize(Atlas& atlas, KeyFrameId id);

  void Observe(PlaceObserver observer) { observer_ = std::move(observer); }

  const std::vector<Recognition>& loops() const { return loops_; }
  const std::vector<MapJoin>& joins() const { return joins_; }

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

  CameraAndPyramid imaging_;
  LoopOptions options_;
  PlaceObserver observer_;
  PlaceIndex places_;
  LoopCloser closer_;
  std::vector<Recognition> loops_;
  std::vector<MapJoin> joins_;
  std::set<MapId> withdrawn_;
};

}  // namespace plumbline
