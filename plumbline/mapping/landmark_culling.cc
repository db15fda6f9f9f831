// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/landmark_culling.h"

#include "plumbline/map/covisibility.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>

namespace plumbline {
namespace {

// A recent landmark must be found in this share of the frames in which it is predicted.
constexpr double kMinFoundRatio = 0.25;
// A landmark is on trial for so many keyframes. After that at least kMinObservations keyframes must
// show it: a landmark that one keyframe shows ties nothing together.
constexpr int kTrialKeyFrames = 3;
constexpr int kMinObservations = 2;
// A keyframe is redundant if so many others show its landmarks. With three, a landmark keeps two
// views when one of these is removed later.
constexpr int kRedundantViews = 3;

enum class Verdict { kKeepWatching, kPassed, kRemove };

template <class Landmark>
Verdict Judge(const Map& map, const Landmark* landmark, KeyFrameId newest) {
  if (landmark == nullptr) return Verdict::kPassed;  // it was removed before
  if (landmark->score.Ratio() < kMinFoundRatio) return Verdict::kRemove;
  if (map.NumberOf(newest) - map.NumberOf(landmark->created_by) < kTrialKeyFrames) {
    return Verdict::kKeepWatching;
  }
  return static_cast<int>(landmark->observations.size()) < kMinObservations ? Verdict::kRemove
                                                                            : Verdict::kPassed;
}

template <class Remove, class LandmarkId>
void JudgeAll(const Map& map, KeyFrameId newest, std::vector<LandmarkId>& young, MapEdit& edit) {
  std::erase_if(young, [&](LandmarkId id) {
    const Verdict verdict = Judge(map, map.Find(id), newest);
    if (verdict == Verdict::kRemove) edit.push_back(Remove{id});
    return verdict != Verdict::kKeepWatching;
  });
}

int OctaveOf(const Map& map, KeyFrameId keyframe, int feature) {
  return map.Find(keyframe)->frame.features().points[static_cast<std::size_t>(feature)].octave;
}

// Returns true if at least `views` of the observations count. Visits no more observations than
// necessary.
template <class Counts>
bool HasViews(const Observations& observations, int views, const Counts& counts) {
  for (auto o = observations.begin(); o != observations.end() && views > 0; ++o) {
    views -= counts(*o);
  }
  return views <= 0;
}

// Numbers of landmarks that a keyframe shares with at least one other.
struct SharedLandmarks {
  int all = 0;
  // Landmarks that too few other keyframes show to make this one redundant.
  int of_few = 0;
};

template <class LandmarkId>
void CountShared(const Map& map,
                 const std::vector<LandmarkId>& matches,
                 int others,
                 SharedLandmarks& count) {
  for (const LandmarkId id : matches) {
    if (!id.valid()) continue;
    const auto views = static_cast<int>(map.Find(id)->observations.size());
    count.all += views >= 2;
    count.of_few += views >= 2 && views - 1 < others;
  }
}

// Two keyframes whose numbers differ by more than this belong to different visits to a place.
constexpr std::int64_t kVisit = 20;

// The rule by which a keyframe is redundant.
struct Redundancy {
  // Share of a keyframe's landmarks that at least kRedundantViews others must show.
  double share = 0.9;
  bool again = false;  // true: one of these others must be of another visit
};

bool IsOfAnotherVisit(const Map& map, KeyFrameId other, const KeyFrame& keyframe) {
  const std::int64_t apart = map.Find(other)->number - keyframe.number;
  return apart > kVisit || apart < -kVisit;
}

// Returns true if other keyframes show the required share of a keyframe's landmarks, points as
// sharply as this keyframe does. The test of the numbers of views comes first, since it alone
// rejects most keyframes.
bool IsRedundant(const Map& map, const KeyFrame& keyframe, const Redundancy& rule) {
  const Frame& frame = keyframe.frame;
  SharedLandmarks shared;
  CountShared(map, frame.points, kRedundantViews, shared);
  CountShared(map, frame.lines, kRedundantViews, shared);
  const auto is_below_share = [&](int own) { return shared.all - own < rule.share * shared.all; };
  if (shared.all == 0 || is_below_share(shared.of_few)) return false;
  const auto is_met_again = [&](const Observations& observations) {
    return !rule.again || std::any_of(observations.begin(), observations.end(), [&](const auto& o) {
      return IsOfAnotherVisit(map, o.first, keyframe);
    });
  };
  int own = 0;
  for (std::size_t i = 0; i < frame.points.size() && !is_below_share(own); ++i) {
    if (!frame.points[i].valid()) continue;
    const auto& observations = map.Find(frame.points[i])->observations;
    if (observations.size() < 2) continue;
    const int octave = frame.features().points[i].octave;
    const bool redundant = HasViews(observations, kRedundantViews, [&](const auto& o) {
      return o.first != keyframe.id && OctaveOf(map, o.first, o.second) <= octave + 1;
    });
    own += !(redundant && is_met_again(observations));
  }
  for (const LineId id : frame.lines) {
    if (!id.valid()) continue;
    const auto& observations = map.Find(id)->observations;
    const auto views = static_cast<int>(observations.size());
    if (views >= 2) own += !(views - 1 >= kRedundantViews && is_met_again(observations));
  }
  return !is_below_share(own);
}

}  // namespace

MapEdit RemoveWeakLandmarks(const Map& map, KeyFrameId newest, RecentLandmarks& young) {
  MapEdit edit;
  JudgeAll<edit::RemovePoint>(map, newest, young.points, edit);
  JudgeAll<edit::RemoveLine>(map, newest, young.lines, edit);
  return edit;
}

namespace {

// Returns the first redundant keyframe among those around `centre`, in the order of covisibility;
// nullptr if none is redundant. The first keyframe of the map, `centre` and the keyframe before it
// are never redundant. Visits at most `most` keyframes.
const KeyFrame* FindRedundant(const Map& map,
                              KeyFrameId centre,
                              std::size_t most,
                              const Redundancy& rule) {
  if (rule.share >= 1) return nullptr;
  const KeyFrameId origin = map.keyframes().begin()->first;
  const auto centre_it = map.keyframes().find(centre);
  const KeyFrameId before =
      centre_it == map.keyframes().begin() ? centre : std::prev(centre_it)->first;
  for (const auto& neighbour : Covisible(map, centre)) {
    if (most-- == 0) break;
    if (neighbour.id == origin || neighbour.id == before) continue;
    const KeyFrame& keyframe = *map.Find(neighbour.id);
    if (keyframe.parent.valid() && IsRedundant(map, keyframe, rule)) return &keyframe;
  }
  return nullptr;
}

// Removes landmarks that too few keyframes show once the keyframe with these matches is removed.
// Landmarks on trial stay.
template <class Remove, class LandmarkId>
void RemoveForsaken(const Map& map,
                    KeyFrameId newest,
                    const std::vector<LandmarkId>& matches,
                    MapEdit& edit) {
  for (const LandmarkId id : matches) {
    if (!id.valid()) continue;
    const auto& landmark = *map.Find(id);
    // Files of merged maps have landmarks whose first keyframe is not known any more.
    const bool on_trial =
        map.Knows(landmark.created_by) &&
        map.NumberOf(newest) - map.NumberOf(landmark.created_by) < kTrialKeyFrames;
    const auto left = static_cast<int>(landmark.observations.size()) - 1;
    if (!on_trial && left < kMinObservations) edit.push_back(Remove{id});
  }
}

}  // namespace

MapEdit RemoveRedundantKeyFrames(const Map& map, KeyFrameId centre, const CleanupOptions& options) {
  const KeyFrame* redundant =
      FindRedundant(map, centre, map.keyframes().size(), {options.redundant_share, false});
  // One keyframe at a time is removed, since each removal changes the shares of the others.
  if (redundant == nullptr) return {};
  return {edit::RemoveKeyFrame{redundant->id}};
}

MapEdit RemoveRevisitedKeyFrames(const Map& map, KeyFrameId centre, const CleanupOptions& options) {
  constexpr std::size_t kLookedAt = 30;
  const KeyFrame* redundant =
      FindRedundant(map, centre, kLookedAt, {options.revisited_share, true});
  if (redundant == nullptr) return {};
  MapEdit edit{edit::RemoveKeyFrame{redundant->id}};
  RemoveForsaken<edit::RemovePoint>(map, centre, redundant->frame.points, edit);
  RemoveForsaken<edit::RemoveLine>(map, centre, redundant->frame.lines, edit);
  return edit;
}

}  // namespace plumbline
