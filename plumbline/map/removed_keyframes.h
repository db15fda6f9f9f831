// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/map/placement.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace plumbline {

// A keyframe that left the map, beside a keyframe that stayed: its parent, or what this one hung on
// when it left itself.
struct RemovedKeyFrame {
  KeyFrameId parent;
  RelativePose from_parent;
  double unit = 1;  // its own when it left
  std::int64_t number = 0;
};

// The keyframes that left a map. Each hangs on one that is in the map: where this one leaves, too,
// what hangs on it hangs on its parent from then on, so that no chains grow however long the map
// is used. A keyframe takes about 180 bytes here.
class RemovedKeyFrames {
 public:
  RemovedKeyFrames() = default;
  explicit RemovedKeyFrames(std::map<KeyFrameId, RemovedKeyFrame> entries);

  const std::map<KeyFrameId, RemovedKeyFrame>& entries() const { return entries_; }
  bool contains(KeyFrameId id) const { return entries_.contains(id); }
  // nullptr where it is not one of them.
  const RemovedKeyFrame* Find(KeyFrameId id) const;

  // The keyframe leaves the map; its parent is in the map. Cost: that of what hangs on it.
  void Add(KeyFrameId id, const RemovedKeyFrame& entry);
  // Those of another map, whose ids are others; their numbers grow by `shift`.
  void Absorb(RemovedKeyFrames other, std::int64_t shift);

 private:
  std::map<KeyFrameId, RemovedKeyFrame> entries_;
  std::map<KeyFrameId, std::vector<KeyFrameId>> hanging_;  // by parent
};

}  // namespace plumbline
