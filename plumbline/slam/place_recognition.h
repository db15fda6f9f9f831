// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/loop_closing/loop_closer.h"
#include "plumbline/loop_closing/place_index.h"
#include "plumbline/map/atlas.h"
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

// Called with each comparison of the newest keyframe with an older one and its result, before the
// maps change. An attempt without a refusal closes a loop or merges the maps of the two.
using PlaceObserver = std::function<void(const Atlas&, const LoopAttempt&)>;

// Recognizes places by an index over the keyframes of all maps: closes loops within the active map,
// and merges that map with another map of the atlas that shows the same place.
//
// Deterministic; for one thread.
class PlaceRecognition {
 public:
  PlaceRecognition(const CameraAndPyramid& imaging, const LoopOptions& options);

  // Adds keyframes new in the maps since the last call, and removes those that left.
  void Follow(const Atlas& atlas);

  // Returns relocalization candidates for an image: the keyframes of all maps most similar in
  // appearance, the most similar first. Withdrawn maps are left out. The result is valid as long as
  // the maps are.
  std::vector<PlaceToTry> PlacesOf(const Atlas& atlas,
                                   const Features& features,
                                   std::size_t most) const;

  // Returns true if a new keyframe shows that the scale of the active map drifts
  // (FindScaleConflict), and then withdraws the map: no map is merged with it any more. Applies
  // only to maps of one camera and their first kYoungKeyFrames keyframes; each is compared with the
  // three older keyframes most similar in appearance.
  static constexpr std::int64_t kYoungKeyFrames = 30;
  bool Withdraws(const Atlas& atlas, KeyFrameId id);
  bool IsWithdrawn(MapId map) const { return withdrawn_.contains(map); }

  // Compares a new keyframe of the active map with older ones; Follow() must have added it. Returns
  // the older keyframe if maps changed at large. Then the landmarks of both are fused, and both are
  // in the active map, which may be another one than before. The caller has to adjust the map.
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
