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
      Rescaled(hanging.from_parent, leaving.scale) * leaving.from_parent.cam_from_keyframe;
  moved.from_parent.scale = leaving.from_parent.scale;
  moved.scale = leaving.scale * hanging.scale / hanging.from_parent.scale;
  return moved;
}

}  // namespace

RemovedKeyFrames::RemovedKeyFrames(const std::map<KeyFrameId, RemovedKeyFrame>& entries) {
  for (const auto& [id, entry] : entries) {
    BesideParent(entry.parent).push_back(id);
    entries_.Insert(id, entry);
  }
}

// Returns the entries that refer to a parent.
std::vector<KeyFrameId>& RemovedKeyFrames::BesideParent(KeyFrameId parent) {
  hanging_.Insert(parent, {});
  return *hanging_.Find(parent);
}

void RemovedKeyFrames::Add(KeyFrameId id, const RemovedKeyFrame& entry) {
  std::vector<KeyFrameId>& beside_parent = BesideParent(entry.parent);
  beside_parent.push_back(id);
  if (const std::vector<KeyFrameId>* hanging = std::as_const(hanging_).Find(id)) {
    for (const KeyFrameId other : *hanging) {
      RemovedKeyFrame& moved = *entries_.Find(other);
      moved = BesideParentOf(entry, moved);
      beside_parent.push_back(other);
    }
    hanging_.Erase(id);
  }
  entries_.Insert(id, entry);
}

void RemovedKeyFrames::ShiftNumbers(std::int64_t shift) {
  entries_.ForEach([&](KeyFrameId, RemovedKeyFrame& entry) { entry.number += shift; });
}

void RemovedKeyFrames::Absorb(const RemovedKeyFrames& other) {
  for (const auto& [id, entry] : other.entries_) entries_.Insert(id, entry);
  for (const auto& [id, hanging] : other.hanging_) hanging_.Insert(id, hanging);
}

}  // namespace plumbline
