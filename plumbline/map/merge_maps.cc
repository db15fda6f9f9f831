// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/merge_maps.h"

#include "plumbline/map/motion.h"

#include <algorithm>
#include <utility>

namespace plumbline {
namespace {

// The ids of the second map behind those of the first.
struct Renumbering {
  std::int64_t keyframes, points, lines;

  KeyFrameId operator()(KeyFrameId id) const { return Behind(id, keyframes); }
  PointId operator()(PointId id) const { return Behind(id, points); }
  LineId operator()(LineId id) const { return Behind(id, lines); }
  Observations operator()(const Observations& observations) const {
    Observations renumbered;
    for (const auto& [keyframe, feature] : observations) {
      renumbered.emplace((*this)(keyframe), feature);
    }
    return renumbered;
  }

 private:
  template <class SomeId>
  static SomeId Behind(SomeId id, std::int64_t first) {
    return id.valid() ? SomeId{id.value + first} : id;
  }
};

// Keyframes that were removed do not come along.
KeyFrameId AncestorInMap(const Map& map, KeyFrameId id) {
  while (id.valid() && map.Find(id) == nullptr) id = map.ParentOf(id);
  return id;
}

template <class Landmark>
void Renumber(const Renumbering& renumbering, Landmark& landmark) {
  landmark.id = renumbering(landmark.id);
  landmark.created_by = renumbering(landmark.created_by);
  landmark.observations = renumbering(landmark.observations);
}

}  // namespace

Map MergeMaps(const Map& first, const Map& second, const Similarity3& first_from_second) {
  const Renumbering renumbering{
      first.NextKeyFrameId().value, first.NextPointId().value, first.NextLineId().value};
  MapEdit edit;
  for (const auto& [id, original] : second.keyframes()) {
    KeyFrame keyframe = original;
    Move(first_from_second, keyframe);
    keyframe.id = renumbering(keyframe.id);
    keyframe.parent = renumbering(AncestorInMap(second, keyframe.parent));
    // Matches come with the observations of the landmarks.
    std::fill(keyframe.frame.points.begin(), keyframe.frame.points.end(), PointId{});
    std::fill(keyframe.frame.lines.begin(), keyframe.frame.lines.end(), LineId{});
    edit.emplace_back(edit::AddKeyFrame{std::move(keyframe)});
  }
  for (const auto& [id, original] : second.points()) {
    MapPoint point = original;
    Move(first_from_second, point);
    Renumber(renumbering, point);
    edit.emplace_back(edit::AddPoint{std::move(point)});
  }
  for (const auto& [id, original] : second.lines()) {
    MapLine line = original;
    Move(first_from_second, line);
    Renumber(renumbering, line);
    edit.emplace_back(edit::AddLine{std::move(line)});
  }
  Map merged = first;
  merged.Apply(edit);
  return merged;
}

}  // namespace plumbline
