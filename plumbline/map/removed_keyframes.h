// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/map/id_table.h"
#include "plumbline/map/keyframe_pose.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace plumbline {

// A removed keyframe, relative to a keyframe of the map: its parent, or the keyframe to which the
// parent referred at the removal.
struct RemovedKeyFrame {
  KeyFrameId parent;
  RelativePose from_parent;
  double scale = 1;  // its own scale at its removal
  std::int64_t number = 0;
};

// Removed keyframes of a map, each relative to one in the map. If that one is removed, too, its
// entries become relative to its parent, so that no chains form however long the map is used. An
// entry takes about 200 bytes.
class RemovedKeyFrames {
 public:
  RemovedKeyFrames() = default;
  // All ids must be valid.
  explicit RemovedKeyFrames(const std::map<KeyFrameId, RemovedKeyFrame>& entries);

  const IdTable<KeyFrameId, RemovedKeyFrame>& entries() const { return entries_; }
  bool contains(KeyFrameId id) const { return entries_.contains(id); }
  // Returns nullptr if the keyframe was not removed.
  const RemovedKeyFrame* Find(KeyFrameId id) const { return entries_.Find(id); }

  // Adds a removed keyframe; its parent must be in the map. Cost: that of the entries relative to
  // it.
  void Add(KeyFrameId id, const RemovedKeyFrame& entry);
  // Adds to the numbers of all entries.
  void ShiftNumbers(std::int64_t shift);
  // Adds the entries of another map with disjoint ids.
  void Absorb(const RemovedKeyFrames& other);

  // As IdTable::Undo.
  class Undo {
   public:
    explicit Undo(RemovedKeyFrames& all) : entries_(all.entries_), hanging_(all.hanging_) {}
    void Keep() {
      entries_.Keep();
      hanging_.Keep();
    }

   private:
    IdTable<KeyFrameId, RemovedKeyFrame>::Undo entries_;
    IdTable<KeyFrameId, std::vector<KeyFrameId>>::Undo hanging_;
  };

 private:
  std::vector<KeyFrameId>& BesideParent(KeyFrameId parent);

  IdTable<KeyFrameId, RemovedKeyFrame> entries_;
  IdTable<KeyFrameId, std::vector<KeyFrameId>> hanging_;  // ids of the entries of each parent
};

}  // namespace plumbline
