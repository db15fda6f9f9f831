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
Verdict Judge(const Map& map,
              const Landmark* landmark,
              KeyFrameId newest,
              const CleanupOptions& options) {
  if (landmark == nullptr) return Verdict::kPassed;  // gone already
  if (landmark->score.Ratio() < options.min_found_ratio) return Verdict::kRemove;
  if (map.NumberOf(newest) - map.NumberOf(landmark->created_by) < options.trial_keyframes) {
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
    const Verdict verdict = Judge(map, map.Find(id), newest, options);
    if (verdict == Verdict::kRemove) edit.push_back(Remove{id});
    return verdict != Verdict::kKeepWatching;
  });
}

int OctaveOf(const Map& map, KeyFrameId keyframe, int feature) {
  return map.Find(keyframe)->frame.features().points[static_cast<std::size_t>(feature)].octave;
}

// Whether at least `views` of the observations count; looks at no more than it needs.
template <class Counts>
bool HasViews(const Observations& observations, int views, const Counts& counts) {
  for (auto o = observations.begin(); o != observations.end() && views > 0; ++o) {
    views -= counts(*o);
  }
  return views <= 0;
}

template <class LandmarkId>
std::ptrdiff_t CountValid(const std::vector<LandmarkId>& matches) {
  return std::count_if(matches.begin(), matches.end(), [](auto id) { return id.valid(); });
}

// Whether other keyframes show the share of a keyframe's landmarks, points as sharply. Most
// keyframes have more landmarks of their own than that, and are not looked at further.
bool IsRedundant(const Map& map, const KeyFrame& keyframe, const CleanupOptions& options) {
  const Frame& frame = keyframe.frame;
  int landmarks = 0;
  int own = 0;
  const auto count = [&](bool redundant) {
    ++landmarks;
    own += !redundant;
  };
  const auto is_below_share = [&](int of) { return of - own < options.redundant_share * of; };
  const auto at_most = static_cast<int>(CountValid(frame.points) + CountValid(frame.lines));
  for (std::size_t i = 0; i < frame.points.size() && !is_below_share(at_most); ++i) {
    if (!frame.points[i].valid()) continue;
    const auto& observations = map.Find(frame.points[i])->observations;
    if (observations.size() < 2) continue;
    const int octave = frame.features().points[i].octave;
    count(HasViews(observations, options.redundant_views, [&](const auto& o) {
      return o.first != keyframe.id && OctaveOf(map, o.first, o.second) <= octave + 1;
    }));
  }
  for (const LineId id : frame.lines) {
    if (!id.valid()) continue;
    const auto views = static_cast<int>(map.Find(id)->observations.size());
    if (views >= 2) count(views - 1 >= options.redundant_views);
  }
  return landmarks > 0 && !is_below_share(landmarks);
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
  for (const auto& neighbour : Covisible(map, centre)) {
    if (neighbour.id == origin || neighbour.id == before) continue;
    if (IsRedundant(map, *map.Find(neighbour.id), options)) {
      // One at a time: what others show changes with each removal.
      return {edit::RemoveKeyFrame{neighbour.id}};
    }
  }
  return {};
}

}  // namespace plumbline
