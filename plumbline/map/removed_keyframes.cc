// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/removed_keyframes.h"

#include <utility>

namespace plumbline {
namespace {

// Returns an entry that referred to a leaving keyframe, relative to the parent of that keyframe.
RemovedKeyFrame BesideParentOf(const RemovedKeyFrame& leaving, const RemovedKeyFrame& hanging) {
  RemovedKeyFrame moved = hanging;
  moved.parent = leaving.parent;
  moved.from_parent.cam_from_keyframe =
      InUnit(hanging.from_parent, leaving.unit) * leaving.from_parent.cam_from_keyframe;
  moved.from_parent.unit = leaving.from_parent.unit;
  moved.unit = leaving.unit * hanging.unit / hanging.from_parent.unit;
  return moved;
}

}  // namespace

RemovedKeyFrames::RemovedKeyFrames(std::map<KeyFrameId, RemovedKeyFrame> entries)
    : entries_(std::move(entries)) {
  for (const auto& [id, entry] : entries_) hanging_[entry.parent].push_back(id);
}

const RemovedKeyFrame* RemovedKeyFrames::Find(KeyFrameId id) const {
  const auto found = entries_.find(id);
  return found == entries_.end() ? nullptr : &found->second;
}

void RemovedKeyFrames::Add(KeyFrameId id, const RemovedKeyFrame& entry) {
  std::vector<KeyFrameId>& beside_parent = hanging_[entry.parent];
  beside_parent.push_back(id);
  const auto hanging = hanging_.find(id);
  if (hanging != hanging_.end()) {
    for (const KeyFrameId other : hanging->second) {
      RemovedKeyFrame& moved = entries_.at(other);
      moved = BesideParentOf(entry, moved);
      beside_parent.push_back(other);
    }
    hanging_.erase(hanging);
  }
  entries_[id] = entry;
}

void RemovedKeyFrames::ShiftNumbers(std::int64_t shift) {
  for (auto& [id, entry] : entries_) entry.number += shift;
}

void RemovedKeyFrames::Absorb(RemovedKeyFrames other) {
  entries_.merge(other.entries_);
  hanging_.merge(other.hanging_);
}

}  // namespace plumbline
