// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/stereo_correction.h"
#include "plumbline/map/edit.h"
#include "plumbline/map/map.h"

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>

namespace plumbline {

// Another stereo correction for all keyframes of a map, at a cost for each step that does not grow
// with the map: the features of some keyframes a step are made ready, and when all are, the map
// takes them at once. Until then the whole map has the correction of before. A map of no more than
// kSlice keyframes gets it with the first step.
//
// The keyframe at which it takes effect depends on the map alone. Not thread-safe.
class StereoChange {
 public:
  static constexpr std::size_t kSlice = 256;  // keyframes a step, some microseconds each

  // The change that is under way. An object that is given this state and the same map completes the
  // change with the same step as this one.
  struct State {
    MapId map;
    StereoCorrection correction;
    KeyFrameId next{0};  // the keyframes before this one are ready

    template <class Self, class Visitor>
    static void VisitState(Self& self, const Visitor& visit) {
      visit(self.map, self.correction, self.next);
    }
  };

  bool Running(const Map& map) const { return state_ && state_->map == map.id(); }
  // Begins a change of this map and gives up one that is under way.
  void Begin(const Map& map, const StereoCorrection& correction);
  // Does one step of the change that is under way for this map, if there is one.
  void Step(Map& map);
  void GiveUp();

  const std::optional<State>& state() const { return state_; }
  void SetState(const std::optional<State>& state);

 private:
  std::optional<State> state_;
  edit::CorrectStereo change_;
  // Features that no keyframe has any more. They are freed step by step, since that takes time,
  // too.
  std::deque<std::shared_ptr<const IndexedFeatures>> retired_;
};

}  // namespace plumbline
