// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/undo_loop.h"

#include "plumbline/loop_closing/essential_graph.h"
#include "plumbline/map/covisibility.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

// The keyframes around both ends of a loop. Ids ascend in the order of time, even in maps that were
// joined.
class Ends {
 public:
  Ends(const Map& map, KeyFrameId query, KeyFrameId candidate)
      : early_end_(std::min(query, candidate)), late_end_(std::max(query, candidate)) {
    early_ = Around(map, early_end_, [&](KeyFrameId id) { return !IsLate(id); });
    late_ = Around(map, late_end_, [&](KeyFrameId id) { return IsLate(id); });
  }

  const std::set<KeyFrameId>& late() const { return late_; }

  bool IsLate(KeyFrameId id) const { return 2 * id.value >= early_end_.value + late_end_.value; }

  // Returns true if the loop fused these observations into one landmark.
  bool Ties(const Observations& seen) const {
    const auto first_late = std::find_if(
        seen.begin(), seen.end(), [&](const auto& entry) { return IsLate(entry.first); });
    if (first_late == seen.begin() || first_late == seen.end()) return false;
    const std::int64_t unseen = first_late->first.value - (first_late - 1)->first.value;
    if (2 * unseen < late_end_.value - early_end_.value) return false;
    return std::any_of(
        seen.begin(), first_late, [&](const auto& entry) { return early_.contains(entry.first); });
  }

 private:
  template <class OfThisEnd>
  static std::set<KeyFrameId> Around(const Map& map, KeyFrameId id, const OfThisEnd& of_this_end) {
    std::set<KeyFrameId> around{id};
    for (const CovisibleKeyFrame& other : Covisible(map, id)) {
      if (of_this_end(other.id)) around.insert(other.id);
    }
    return around;
  }

  KeyFrameId early_end_, late_end_;
  std::set<KeyFrameId> early_, late_;
};

template <class LandmarkId>
void AddShown(const std::vector<LandmarkId>& matches, std::set<LandmarkId>& shown) {
  for (const LandmarkId id : matches) {
    if (id.valid()) shown.insert(id);
  }
}

void Unobserve(PointId id, KeyFrameId keyframe, MapEdit& edit) {
  edit.push_back(edit::RemovePointObservation{id, keyframe});
}
void Unobserve(LineId id, KeyFrameId keyframe, MapEdit& edit) {
  edit.push_back(edit::RemoveLineObservation{id, keyframe});
}

void AddAndRefresh(MapPoint later, PointId earlier, MapEdit& edit) {
  const PointId id = later.id;
  edit.push_back(edit::AddPoint{std::move(later)});
  edit.push_back(edit::RefreshPoint{id});
  edit.push_back(edit::RefreshPoint{earlier});
}
void AddAndRefresh(MapLine later, LineId earlier, MapEdit& edit) {
  const LineId id = later.id;
  edit.push_back(edit::AddLine{std::move(later)});
  edit.push_back(edit::RefreshLine{id});
  edit.push_back(edit::RefreshLine{earlier});
}

// Splits the landmarks that the loop ties. `next` is the id of the first new landmark.
template <class LandmarkId>
void Part(const Map& map,
          const std::set<LandmarkId>& shown,
          const Ends& ends,
          LandmarkId next,
          MapEdit& edit) {
  for (const LandmarkId id : shown) {
    const auto& landmark = *map.Find(id);
    if (!ends.Ties(landmark.observations)) continue;
    auto later = landmark;
    later.id = next;
    next = LandmarkId{next.value + 1};
    later.observations = Observations();
    for (const auto& [keyframe, feature] : landmark.observations) {
      if (!ends.IsLate(keyframe)) continue;
      Unobserve(id, keyframe, edit);
      later.observations.emplace(keyframe, feature);
    }
    later.created_by = later.observations.begin()->first;
    AddAndRefresh(std::move(later), id, edit);
  }
}

}  // namespace

MapEdit UndoLoop(const Map& map, const LoopEdge& loop) {
  const KeyFrameId query = NearestAncestor(map, loop.query);
  const KeyFrameId candidate = NearestAncestor(map, loop.candidate);
  if (!query.valid() || !candidate.valid() || query == candidate) return {};
  const Ends ends(map, query, candidate);
  std::set<PointId> points;
  std::set<LineId> lines;
  for (const KeyFrameId id : ends.late()) {
    const Frame& frame = map.Find(id)->frame;
    AddShown(frame.points, points);
    AddShown(frame.lines, lines);
  }
  MapEdit edit;
  Part(map, points, ends, map.NextPointId(), edit);
  Part(map, lines, ends, map.NextLineId(), edit);
  return edit;
}

}  // namespace plumbline
