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
// When it takes effect depends on the map alone. Not thread-safe.
class StereoChange {
 public:
  static constexpr std::size_t kSlice = 256;  // keyframes a step; some microseconds for each

  // What is under way. Another one that is given this and the same map ends with the same step.
  struct State {
    MapId map;
    StereoCorrection correction;
    KeyFrameId next{0};  // those before are ready

    template <class Self, class Visitor>
    static void VisitState(Self& self, const Visitor& visit) {
      visit(self.map, self.correction, self.next);
    }
  };

  bool Running(const Map& map) const { return state_ && state_->map == map.id(); }
  // Begins anew for this map; what was under way is given up.
  void Begin(const Map& map, const StereoCorrection& correction);
  // Goes on with what is under way for this map.
  void Step(Map& map);
  void GiveUp();

  const std::optional<State>& state() const { return state_; }
  void SetState(const std::optional<State>& state);

 private:
  std::optional<State> state_;
  edit::CorrectStereo change_;
  // Features that no keyframe has any more: to free them takes time, too.
  std::deque<std::shared_ptr<const IndexedFeatures>> retired_;
};

}  // namespace plumbline
