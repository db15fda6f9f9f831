// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/pending_keyframes.h"

#include "plumbline/base/error.h"
#include "plumbline/geometry/measured_depth.h"
#include "plumbline/mapping/landmark_creation.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

namespace plumbline {
namespace {

constexpr std::int64_t kFirstProvisional = std::int64_t{1} << 60;
constexpr std::int64_t kFeatures = std::int64_t{1} << 20;  // most features of a keyframe

const std::vector<PointId>& Matches(const Frame& frame, PointId) { return frame.points; }
const std::vector<LineId>& Matches(const Frame& frame, LineId) { return frame.lines; }

// Returns the landmark that the map has in place of a provisional one: the landmark that its
// keyframe, once mapped, shows by the same feature.
template <class LandmarkId>
LandmarkId ShownBy(const KeyFrame& keyframe, const ProvisionalLandmark& landmark) {
  return Matches(keyframe.frame, LandmarkId{}).at(landmark.feature);
}

template <class LandmarkId>
void Settle(const Map& map, std::vector<LandmarkId>& matches) {
  for (LandmarkId& id : matches) {
    const auto provisional = FindProvisional(id);
    if (!provisional) continue;
    const KeyFrame* keyframe = map.Find(provisional->keyframe);
    id = keyframe != nullptr ? ShownBy<LandmarkId>(*keyframe, *provisional) : LandmarkId{};
  }
}

template <class Landmark, class LandmarkId>
Landmark* FindById(std::vector<Landmark>& sorted, LandmarkId id) {
  const auto at = std::lower_bound(
      sorted.begin(), sorted.end(), id, [](const Landmark& l, LandmarkId i) { return l.id < i; });
  return at != sorted.end() && at->id == id ? &*at : nullptr;
}

// Counts one more observation of each landmark of the snapshot that a keyframe shows. A match with
// a provisional landmark of the keyframe `mapped` becomes a match with the landmark that the map
// has in its place. Matches with landmarks that the snapshot does not have are removed.
template <class LandmarkId, class Landmark>
void CountShown(const KeyFrame& mapped,
                std::vector<Landmark>& landmarks,
                std::vector<LandmarkId>& matches) {
  for (LandmarkId& id : matches) {
    if (!id.valid()) continue;
    Landmark* landmark = FindById(landmarks, id);
    const auto provisional = FindProvisional(id);
    if (landmark == nullptr && provisional && provisional->keyframe == mapped.id) {
      id = ShownBy<LandmarkId>(mapped, *provisional);
      landmark = FindById(landmarks, id);
    }
    if (landmark == nullptr) {
      id = LandmarkId{};
    } else {
      ++landmark->observation_count;
    }
  }
}

template <class LandmarkId, class Landmark, class Model>
void AddNew(KeyFrameId keyframe,
            std::vector<std::pair<std::size_t, Model>>& models,
            std::vector<Landmark>& landmarks,
            std::vector<LandmarkId>& matches) {
  std::sort(
      models.begin(), models.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [feature, model] : models) {
    const auto id = ProvisionalId<LandmarkId>({keyframe, feature});
    landmarks.push_back({model, id, 1});
    matches[feature] = id;
  }
}

template <class Feature, class LandmarkId, class Depth>
int CountNew(const std::vector<Feature>& features,
             const std::vector<LandmarkId>& matches,
             const OptionalList<Depth>& depths,
             bool need_depth) {
  int count = 0;
  for (std::size_t i = 0; i < features.size(); ++i) {
    count += !matches[i].valid() && (!need_depth || depths[i].has_value());
  }
  return count;
}

// Hands the provisional landmarks of a removed keyframe to its heirs. The first keyframe that shows
// one of them makes it anew from its own depths; later keyframes match with that new landmark.
template <class LandmarkId>
void PassOn(KeyFrameId gone,
            KeyFrameId to,
            std::map<LandmarkId, LandmarkId>& heirs,
            std::vector<LandmarkId>& matches) {
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const auto provisional = FindProvisional(matches[i]);
    if (!provisional || provisional->keyframe != gone) continue;
    const auto [heir, is_new] = heirs.try_emplace(matches[i], ProvisionalId<LandmarkId>({to, i}));
    matches[i] = is_new ? LandmarkId{} : heir->second;
  }
}

template <class LandmarkId>
void AddScores(const std::map<LandmarkId, TrackingScore>& from,
               std::map<LandmarkId, TrackingScore>& to) {
  for (const auto& [id, score] : from) {
    TrackingScore& sum = to.try_emplace(id, TrackingScore{0, 0}).first->second;
    sum.visible += score.visible;
    sum.found += score.found;
  }
}

}  // namespace

template <class LandmarkId>
LandmarkId ProvisionalId(const ProvisionalLandmark& landmark) {
  PLUMBLINE_CHECK(landmark.feature < static_cast<std::size_t>(kFeatures),
                  "fewer features than provisional ids");
  return LandmarkId{kFirstProvisional + landmark.keyframe.value * kFeatures +
                    static_cast<std::int64_t>(landmark.feature)};
}

template <class LandmarkId>
std::optional<ProvisionalLandmark> FindProvisional(LandmarkId id) {
  if (id.value < kFirstProvisional) return std::nullopt;
  const std::int64_t value = id.value - kFirstProvisional;
  return ProvisionalLandmark{KeyFrameId{value / kFeatures},
                             static_cast<std::size_t>(value % kFeatures)};
}

template PointId ProvisionalId(const ProvisionalLandmark&);
template LineId ProvisionalId(const ProvisionalLandmark&);
template std::optional<ProvisionalLandmark> FindProvisional(PointId);
template std::optional<ProvisionalLandmark> FindProvisional(LineId);

std::shared_ptr<const MapSnapshot> WithPendingKeyFrames(
    const MapSnapshot& snapshot,
    const std::vector<std::shared_ptr<const NewKeyFrame>>& ahead,
    const RectifiedCamera& camera,
    const LandmarkCreationOptions& options) {
  auto result = std::make_shared<MapSnapshot>(snapshot);
  const KeyFrame& mapped = *snapshot.reference;
  for (const auto& added : ahead) {
    auto keyframe = std::make_shared<KeyFrame>(added->keyframe);
    Frame& frame = keyframe->frame;
    const auto parent = result->places.find(keyframe->parent);
    if (parent != result->places.end()) {
      frame.cam_from_world = ComposePose(parent->second, added->from_parent);
      keyframe->scale = parent->second.scale;
    }
    frame.indexed = WithCorrection(frame.indexed, snapshot.correction);
    CountShown(mapped, result->points, frame.points);
    CountShown(mapped, result->lines, frame.lines);
    DepthLandmarks landmarks = LandmarksFromDepth(camera, frame, options);
    AddNew(keyframe->id, landmarks.points, result->points, frame.points);
    AddNew(keyframe->id, landmarks.lines, result->lines, frame.lines);
    result->cam_from_world.emplace(keyframe->id, frame.cam_from_world);
    result->places.emplace(keyframe->id, KeyFramePose{frame.cam_from_world, keyframe->scale});
    result->centre = keyframe->id;
    result->reference = std::move(keyframe);
  }
  return result;
}

KeyFrame SettledIn(const Map& map, const NewKeyFrame& added) {
  KeyFrame keyframe = added.keyframe;
  if (keyframe.parent.valid()) {
    const KeyFramePose parent = map.PlaceOf(keyframe.parent);
    keyframe.frame.cam_from_world = ComposePose(parent, added.from_parent);
    keyframe.scale = parent.scale;
  }
  Settle(map, keyframe.frame.points);
  Settle(map, keyframe.frame.lines);
  return keyframe;
}

int NewMeasurements(const NewKeyFrame& added, const RectifiedCamera& camera) {
  const Frame& frame = added.keyframe.frame;
  const Features& features = frame.features();
  const bool need_depth = MeasuresDepth(camera);
  return CountNew(features.points, frame.points, features.point_disparity, need_depth) +
         CountNew(features.lines, frame.lines, features.line_right, need_depth);
}

std::shared_ptr<const NewKeyFrame> TakeOut(
    std::size_t place, std::vector<std::shared_ptr<const NewKeyFrame>>& waiting) {
  PLUMBLINE_CHECK(place + 1 < waiting.size(), "the newest keyframe is not taken out");
  const std::shared_ptr<const NewKeyFrame> gone = waiting[place];
  waiting.erase(waiting.begin() + static_cast<std::ptrdiff_t>(place));
  std::map<PointId, PointId> heirs_of_points;
  std::map<LineId, LineId> heirs_of_lines;
  for (std::size_t i = place; i < waiting.size(); ++i) {
    NewKeyFrame later = *waiting[i];
    KeyFrame& keyframe = later.keyframe;
    if (keyframe.parent == gone->keyframe.id) {
      keyframe.parent = gone->keyframe.parent;
      later.from_parent = Chained(later.from_parent, gone->from_parent);
    }
    PassOn(gone->keyframe.id, keyframe.id, heirs_of_points, keyframe.frame.points);
    PassOn(gone->keyframe.id, keyframe.id, heirs_of_lines, keyframe.frame.lines);
    if (i == place) {
      AddScores(gone->scores.points, later.scores.points);
      AddScores(gone->scores.lines, later.scores.lines);
    }
    waiting[i] = std::make_shared<const NewKeyFrame>(std::move(later));
  }
  return gone;
}

}  // namespace plumbline
