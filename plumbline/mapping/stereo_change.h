// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/stereo_correction.h"
#include "plumbline/map/atlas.h"
#include "plumbline/map/edit.h"
#include "plumbline/map/map.h"

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>

namespace plumbline {

// Applies another stereo correction to all keyframes of a map, at a cost for each step that does
// not grow with the map. Each step prepares the features of some keyframes; when all are prepared,
// the map gets them at once. Until then the whole map keeps the old correction. A map of no more
// than kSlice keyframes changes with the first step.
//
// The keyframe at which the change takes effect depends on the map alone. Not thread-safe.
class StereoChange {
 public:
  // Number of keyframes prepared in one step, some microseconds each.
  static constexpr std::size_t kSlice = 256;

  bool Running(const Map& map) const { return state_ && state_->map == map.id(); }
  // Begins a change of this map and cancels one in progress.
  void Begin(const Map& map, const StereoCorrection& correction);
  // Does one step of the change in progress for this map, if any.
  void Step(Map& map);
  void GiveUp();
  // Gives up a change of a map that has been joined to another one, which has its own correction.
  void FollowJoins(const Atlas& atlas);
  // The correction that the map is about to get. Only where a change is running.
  const StereoCorrection& correction() const { return state_->correction; }

 private:
  struct State {
    MapId map;
    StereoCorrection correction;
    KeyFrameId next{0};  // the keyframes before this one are ready
  };

  std::optional<State> state_;
  edit::CorrectFeatures change_;
  // Replaced features. They are freed step by step, since freeing takes time.
  std::deque<std::shared_ptr<const FrameFeatures>> retired_;
};

}  // namespace plumbline
