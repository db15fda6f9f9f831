// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/stereo_change.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace plumbline {

void StereoChange::Begin(const Map& map, const StereoCorrection& correction) {
  state_ = State{map.id(), correction};
  change_ = {};
}

void StereoChange::GiveUp() {
  state_.reset();
  change_ = {};
}

void StereoChange::FollowJoins(const Atlas& atlas) {
  if (state_ && atlas.Find(state_->map) == nullptr) GiveUp();
}

void StereoChange::Step(Map& map) {
  const auto freed = static_cast<std::ptrdiff_t>(std::min(kSlice, retired_.size()));
  retired_.erase(retired_.begin(), retired_.begin() + freed);
  if (!Running(map)) return;
  const FeatureCorrection correction{state_->correction, map.correction().lens};
  auto keyframe = map.keyframes().lower_bound(state_->next);
  for (std::size_t i = 0; i < kSlice && keyframe != map.keyframes().end(); ++i, ++keyframe) {
    const auto& [id, added] = *keyframe;
    change_.ready.emplace_back(id, WithCorrection(added.frame.indexed, correction));
    state_->next = KeyFrameId{id.value + 1};
  }
  if (keyframe != map.keyframes().end()) return;
  if (map.keyframes().size() > kSlice) {
    for (const auto& [id, changed] : map.keyframes()) retired_.push_back(changed.frame.indexed);
  }
  change_.correction = correction;
  map.Apply({std::move(change_)});
  GiveUp();
}

}  // namespace plumbline
