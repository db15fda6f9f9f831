// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/landmark_cleanup.h"

#include "plumbline/map/covisibility.h"

#include <algorithm>
#include <cstddef>

namespace plumbline {
namespace {

enum class Verdict { kKeepWatching, kPassed, kRemove };

template <class Landmark>
Verdict Judge(const Landmark* landmark, KeyFrameId newest, const CleanupOptions& options) {
  if (landmark == nullptr) return Verdict::kPassed;  // gone already
  if (landmark->score.Ratio() < options.min_found_ratio) return Verdict::kRemove;
  if (newest.value - landmark->created_by.value < options.trial_keyframes) {
    return Verdict::kKeepWatching;
  }
  return static_cast<int>(landmark->observations.size()) < options.min_observations
             ? Verdict::kRemove
             : Verdict::kPassed;
}

template <class Remove, class LandmarkId>
void JudgeAll(const Map& map,
              KeyFrameId newest,
              const CleanupOptions& options,
              std::vector<LandmarkId>& young,
              MapEdit& edit) {
  std::erase_if(young, [&](LandmarkId id) {
    const Verdict verdict = Judge(map.Find(id), newest, options);
    if (verdict == Verdict::kRemove) edit.push_back(Remove{id});
    return verdict != Verdict::kKeepWatching;
  });
}

// How many of a keyframe's landmarks there are and how many others show as well.
struct Redundancy {
  int landmarks = 0;
  int redundant = 0;
};

int OctaveOf(const Map& map, KeyFrameId keyframe, int feature) {
  return map.Find(keyframe)->frame.features().points[static_cast<std::size_t>(feature)].octave;
}

Redundancy RedundancyOf(const Map& map, const KeyFrame& keyframe, int views) {
  Redundancy result;
  for (std::size_t i = 0; i < keyframe.frame.points.size(); ++i) {
    const PointId id = keyframe.frame.points[i];
    if (!id.valid()) continue;
    const auto& observations = map.Find(id)->observations;
    if (observations.size() < 2) continue;
    const int octave = keyframe.frame.features().points[i].octave;
    const auto others = std::count_if(observations.begin(), observations.end(), [&](const auto& o) {
      return o.first != keyframe.id && OctaveOf(map, o.first, o.second) <= octave + 1;
    });
    ++result.landmarks;
    result.redundant += others >= views;
  }
  for (const LineId id : keyframe.frame.lines) {
    if (!id.valid()) continue;
    const auto count = static_cast<int>(map.Find(id)->observations.size());
    if (count < 2) continue;
    ++result.landmarks;
    result.redundant += count - 1 >= views;
  }
  return result;
}

}  // namespace

MapEdit RemoveWeakLandmarks(const Map& map,
                            KeyFrameId newest,
                            const CleanupOptions& options,
                            YoungLandmarks& young) {
  MapEdit edit;
  JudgeAll<edit::RemovePoint>(map, newest, options, young.points, edit);
  JudgeAll<edit::RemoveLine>(map, newest, options, young.lines, edit);
  return edit;
}

MapEdit RemoveRedundantKeyFrames(const Map& map, KeyFrameId centre, const CleanupOptions& options) {
  if (options.redundant_share >= 1) return {};
  const KeyFrameId origin = map.keyframes().begin()->first;
  const auto centre_it = map.keyframes().find(centre);
  const KeyFrameId before =
      centre_it == map.keyframes().begin() ? centre : std::prev(centre_it)->first;
  for (const auto& neighbour : Covisible(map, centre, 10)) {
    if (neighbour.id == origin || neighbour.id == before) continue;
    const Redundancy r = RedundancyOf(map, *map.Find(neighbour.id), options.redundant_views);
    if (r.landmarks > 0 && r.redundant >= options.redundant_share * r.landmarks) {
      // One at a time: what others show changes with each removal.
      return {edit::RemoveKeyFrame{neighbour.id}};
    }
  }
  return {};
}

}  // namespace plumbline
