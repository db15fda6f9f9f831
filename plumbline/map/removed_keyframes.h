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

// A keyframe that left the map, relative to a keyframe that stayed: its parent, or the keyframe to
// which the parent referred when it left.
struct RemovedKeyFrame {
  KeyFrameId parent;
  RelativePose from_parent;
  double scale = 1;  // its own scale when it left
  std::int64_t number = 0;
};

// The keyframes that left a map. Each refers to one that is in the map. When that one leaves, too,
// all that refers to it refers to its parent from then on, so that no chains grow however long the
// map is used. A removed keyframe takes about 200 bytes.
class RemovedKeyFrames {
 public:
  RemovedKeyFrames() = default;
  // All ids must be valid.
  explicit RemovedKeyFrames(const std::map<KeyFrameId, RemovedKeyFrame>& entries);

  const IdTable<KeyFrameId, RemovedKeyFrame>& entries() const { return entries_; }
  bool contains(KeyFrameId id) const { return entries_.contains(id); }
  // Returns nullptr where the keyframe was not removed.
  const RemovedKeyFrame* Find(KeyFrameId id) const { return entries_.Find(id); }

  // Adds a keyframe that leaves the map; its parent must be in the map. Cost: that of the entries
  // that refer to it.
  void Add(KeyFrameId id, const RemovedKeyFrame& entry);
  // Adds to the numbers of all entries.
  void ShiftNumbers(std::int64_t shift);
  // Takes in the entries of another map, which uses other ids.
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
