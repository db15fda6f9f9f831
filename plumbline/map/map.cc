// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/map.h"

#include "plumbline/base/error.h"
#include "plumbline/map/appearance.h"
#include "plumbline/map/motion.h"

#include <algorithm>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

namespace plumbline {
namespace {

// Follows the merges from an id to the landmark that it is part of today.
template <class LandmarkId, class Landmark>
LandmarkId Follow(const IdTable<LandmarkId, LandmarkId>& merged,
                  const IdTable<LandmarkId, Landmark>& landmarks,
                  LandmarkId id) {
  while (const LandmarkId* kept = merged.Find(id)) id = *kept;
  return landmarks.Find(id) != nullptr ? id : LandmarkId{};
}

std::vector<PointId>& Matches(Frame& frame, PointId) { return frame.points; }
std::vector<LineId>& Matches(Frame& frame, LineId) { return frame.lines; }
const std::vector<PointId>& Matches(const Frame& frame, PointId) { return frame.points; }
const std::vector<LineId>& Matches(const Frame& frame, LineId) { return frame.lines; }

}  // namespace

const KeyFrame* Map::Find(KeyFrameId id) const { return keyframes_.Find(id); }
const MapPoint* Map::Find(PointId id) const { return points_.Find(id); }
const MapLine* Map::Find(LineId id) const { return lines_.Find(id); }

PointId Map::Current(PointId id) const { return Follow(merged_points_, points_, id); }
LineId Map::Current(LineId id) const { return Follow(merged_lines_, lines_, id); }

bool Map::Knows(KeyFrameId id) const {
  return Find(id) != nullptr || removed_keyframes_.contains(id);
}

std::int64_t Map::NumberOf(KeyFrameId id) const {
  if (const KeyFrame* keyframe = Find(id)) return keyframe->number;
  const RemovedKeyFrame* removed = removed_keyframes_.Find(id);
  PLUMBLINE_CHECK(removed != nullptr, "a keyframe that never was in the map");
  return removed->number;
}

KeyFrameId Map::ParentOf(KeyFrameId id) const {
  if (const KeyFrame* keyframe = Find(id)) return keyframe->parent;
  const RemovedKeyFrame* removed = removed_keyframes_.Find(id);
  return removed == nullptr ? KeyFrameId{} : removed->parent;
}

KeyFramePose Map::PlaceOf(KeyFrameId id) const {
  // Goes up to a keyframe that is in the map: one step, except in maps of older files.
  std::vector<const RemovedKeyFrame*> chain;
  while (const RemovedKeyFrame* removed = removed_keyframes_.Find(id)) {
    chain.push_back(removed);
    id = removed->parent;
  }
  const KeyFrame* keyframe = Find(id);
  PLUMBLINE_CHECK(keyframe != nullptr, "place of a keyframe that never was in the map");
  double scale = keyframe->scale;
  Rigid3 cam_from_ancestor;
  for (auto removed = chain.rbegin(); removed != chain.rend(); ++removed) {
    const RelativePose& relative = (*removed)->from_parent;
    cam_from_ancestor = Rescaled(relative, scale) * cam_from_ancestor;
    scale *= (*removed)->scale / relative.scale;
  }
  return {cam_from_ancestor * keyframe->frame.cam_from_world, scale};
}

void Map::ReserveIds(PointId next_point, LineId next_line) {
  next_point_ = std::max(next_point_, next_point);
  next_line_ = std::max(next_line_, next_line);
}

MapRecord Map::Record() const {
  return {id_,
          version_,
          keyframes_taken_in_,
          next_keyframe_,
          next_point_,
          next_line_,
          correction_,
          {removed_keyframes_.entries().begin(), removed_keyframes_.entries().end()},
          {merged_points_.begin(), merged_points_.end()},
          {merged_lines_.begin(), merged_lines_.end()}};
}

// Carries out single changes; std::visit calls its overloads of Do().
struct MapChanger {
  Map& map;

  auto& Landmarks(PointId) { return map.points_; }
  auto& Landmarks(LineId) { return map.lines_; }
  auto& Merged(PointId) { return map.merged_points_; }
  auto& Merged(LineId) { return map.merged_lines_; }

  KeyFrame* FindKeyFrame(KeyFrameId id) { return map.keyframes_.Find(id); }
  template <class LandmarkId>
  auto* FindLandmark(LandmarkId id) {
    return Landmarks(id).Find(id);
  }

  // Adds an observation. A keyframe shows a landmark with one feature, and a feature shows one
  // landmark, so that earlier observations of either are removed.
  template <class LandmarkId>
  void Observe(LandmarkId id, KeyFrameId keyframe_id, int feature) {
    auto* landmark = FindLandmark(id);
    KeyFrame* keyframe = FindKeyFrame(keyframe_id);
    if (landmark == nullptr || keyframe == nullptr ||
        landmark->observations.contains(keyframe_id)) {
      return;
    }
    LandmarkId& match = Matches(keyframe->frame, id)[static_cast<std::size_t>(feature)];
    if (match.valid()) Unobserve(match, keyframe_id);
    Matches(keyframe->frame, id)[static_cast<std::size_t>(feature)] = id;
    landmark->observations.emplace(keyframe_id, feature);
  }

  // Removes an observation. A landmark without observations leaves the map.
  template <class LandmarkId>
  void Unobserve(LandmarkId id, KeyFrameId keyframe_id) {
    auto* landmark = FindLandmark(id);
    if (landmark == nullptr) return;
    const auto it = landmark->observations.find(keyframe_id);
    if (it == landmark->observations.end()) return;
    if (KeyFrame* keyframe = FindKeyFrame(keyframe_id)) {
      Matches(keyframe->frame, id)[static_cast<std::size_t>(it->second)] = LandmarkId{};
    }
    landmark->observations.erase(it);
    if (landmark->observations.empty()) Landmarks(id).Erase(id);
  }

  template <class LandmarkId>
  void Remove(LandmarkId id) {
    auto* landmark = FindLandmark(id);
    if (landmark == nullptr) return;
    for (const auto& [keyframe_id, feature] : landmark->observations) {
      if (KeyFrame* keyframe = FindKeyFrame(keyframe_id)) {
        Matches(keyframe->frame, id)[static_cast<std::size_t>(feature)] = LandmarkId{};
      }
    }
    Landmarks(id).Erase(id);
  }

  template <class LandmarkId, class Landmark>
  void Add(LandmarkId id, Landmark landmark, LandmarkId& next) {
    PLUMBLINE_CHECK(id >= next, "id of a new landmark is not new");
    next = LandmarkId{id.value + 1};
    const Observations observations = std::exchange(landmark.observations, {});
    Landmarks(id).Insert(id, std::move(landmark));
    for (const auto& [keyframe_id, feature] : observations) Observe(id, keyframe_id, feature);
    if (FindLandmark(id)->observations.empty()) Landmarks(id).Erase(id);
  }

  template <class LandmarkId>
  void Merge(LandmarkId kept, LandmarkId gone) {
    auto* to = FindLandmark(kept);
    auto* from = FindLandmark(gone);
    if (to == nullptr || from == nullptr || kept == gone) return;
    const Observations observations = from->observations;
    const TrackingScore score = from->score;
    Remove(gone);
    for (const auto& [keyframe_id, feature] : observations) Observe(kept, keyframe_id, feature);
    to->score.visible += score.visible;
    to->score.found += score.found;
    auto& merged = Merged(kept);
    merged.Insert(gone, kept);
    if (merged.size() > Map::kMostMerges) merged.Erase(merged.begin()->first);
  }

  template <class LandmarkId>
  void Score(LandmarkId id, int visible, int found) {
    if (auto* landmark = FindLandmark(id)) {
      landmark->score.visible += visible;
      landmark->score.found += found;
    }
  }

  // Moves each landmark with the newest keyframe that shows it.
  template <class LandmarkId, class Landmark>
  static void MoveLandmarks(IdTable<LandmarkId, Landmark>& landmarks,
                            const edit::MoveKeyFrames& change) {
    landmarks.ForEach([&](LandmarkId, Landmark& landmark) {
      const auto motion = change.new_from_old.find(landmark.observations.newest().first);
      if (motion != change.new_from_old.end()) Move(motion->second, landmark);
    });
  }

  // Makes the matches of a new keyframe observations of the landmarks as they are today.
  template <class LandmarkId>
  void ObserveMatches(KeyFrameId keyframe_id, const std::vector<LandmarkId>& matches) {
    for (std::size_t i = 0; i < matches.size(); ++i) {
      const LandmarkId id = map.Current(matches[i]);
      if (id.valid()) Observe(id, keyframe_id, static_cast<int>(i));
    }
  }

  void Do(const edit::AddKeyFrame& change) {
    KeyFrame keyframe = change.keyframe;
    const KeyFrameId id = keyframe.id;
    PLUMBLINE_CHECK(!map.Knows(id), "id of a new keyframe is not new");
    map.next_keyframe_ = std::max(map.next_keyframe_, KeyFrameId{id.value + 1});
    keyframe.number = map.keyframes_taken_in_++;
    const auto points = std::exchange(keyframe.frame.points, {});
    const auto lines = std::exchange(keyframe.frame.lines, {});
    keyframe.frame.points.resize(points.size());
    keyframe.frame.lines.resize(lines.size());
    keyframe.frame.indexed = WithCorrection(keyframe.frame.indexed, map.correction_);
    map.keyframes_.Insert(id, std::move(keyframe));
    ObserveMatches(id, points);
    ObserveMatches(id, lines);
  }

  void Do(const edit::RemoveKeyFrame& change) {
    KeyFrame* keyframe = FindKeyFrame(change.id);
    if (keyframe == nullptr || !keyframe->parent.valid()) return;
    KeyFrameId parent_id = keyframe->parent;
    while (FindKeyFrame(parent_id) == nullptr) {
      PLUMBLINE_CHECK(map.removed_keyframes_.contains(parent_id), "a parent that never was");
      parent_id = map.ParentOf(parent_id);
    }
    const KeyFramePose parent = map.PlaceOf(parent_id);
    const Rigid3 cam_from_parent = keyframe->frame.cam_from_world * Inverse(parent.cam_from_world);
    map.removed_keyframes_.Add(
        change.id, {parent_id, {cam_from_parent, parent.scale}, keyframe->scale, keyframe->number});
    const Frame frame = keyframe->frame;
    for (const PointId id : frame.points) Unobserve(id, change.id);
    for (const LineId id : frame.lines) Unobserve(id, change.id);
    map.keyframes_.Erase(change.id);
  }

  void Do(const edit::SetPose& change) {
    if (KeyFrame* keyframe = FindKeyFrame(change.id)) {
      keyframe->frame.cam_from_world = change.cam_from_world;
    }
  }

  void Do(const edit::MoveKeyFrames& change) {
    MoveLandmarks(map.points_, change);
    MoveLandmarks(map.lines_, change);
    for (const auto& [id, motion] : change.new_from_old) {
      if (KeyFrame* keyframe = FindKeyFrame(id)) Move(motion, *keyframe);
    }
  }

  void Do(const edit::CorrectFeatures& change) {
    map.correction_ = change.correction;
    auto ready = change.ready.begin();
    map.keyframes_.ForEach([&](KeyFrameId id, KeyFrame& keyframe) {
      while (ready != change.ready.end() && ready->first < id) ++ready;
      const bool is_ready = ready != change.ready.end() && ready->first == id &&
                            ready->second->correction == change.correction;
      auto& indexed = keyframe.frame.indexed;
      indexed = is_ready ? ready->second : WithCorrection(indexed, change.correction);
    });
  }

  void Do(const edit::MoveFeatures& change) {
    if (KeyFrame* keyframe = FindKeyFrame(change.id)) {
      keyframe->frame.indexed = WithCorrection(change.indexed, map.correction_);
    }
  }

  void Do(const edit::AddPoint& c) { Add(c.landmark.id, c.landmark, map.next_point_); }
  void Do(const edit::AddLine& c) { Add(c.landmark.id, c.landmark, map.next_line_); }
  void Do(const edit::RemovePoint& change) { Remove(change.id); }
  void Do(const edit::RemoveLine& change) { Remove(change.id); }
  void Do(const edit::MovePoint& change) {
    if (MapPoint* point = FindLandmark(change.id)) point->position = change.position;
  }
  void Do(const edit::MoveLine& change) {
    if (MapLine* line = FindLandmark(change.id)) {
      line->line = change.line;
      line->start = change.start;
      line->end = change.end;
      line->information = change.information;
    }
  }
  void Do(const edit::AddPointObservation& c) { Observe(c.id, c.keyframe, c.feature); }
  void Do(const edit::AddLineObservation& c) { Observe(c.id, c.keyframe, c.feature); }
  void Do(const edit::RemovePointObservation& c) { Unobserve(c.id, c.keyframe); }
  void Do(const edit::RemoveLineObservation& c) { Unobserve(c.id, c.keyframe); }
  void Do(const edit::MergePoints& change) { Merge(change.kept, change.gone); }
  void Do(const edit::MergeLines& change) { Merge(change.kept, change.gone); }
  template <class Id>
  void Do(const edit::Refresh<Id>& change) {
    if (auto* landmark = FindLandmark(change.id)) RefreshAppearance(map.keyframes_, *landmark);
  }
  void Do(const edit::ScorePoint& change) { Score(change.id, change.visible, change.found); }
  void Do(const edit::ScoreLine& change) { Score(change.id, change.visible, change.found); }
};

// A map as it was.
struct Map::Undo::Before {
  explicit Before(Map& map)
      : version(map.version_),
        keyframes_taken_in(map.keyframes_taken_in_),
        next_keyframe(map.next_keyframe_),
        next_point(map.next_point_),
        next_line(map.next_line_),
        correction(map.correction_),
        keyframes(map.keyframes_),
        points(map.points_),
        lines(map.lines_),
        removed_keyframes(map.removed_keyframes_),
        merged_points(map.merged_points_),
        merged_lines(map.merged_lines_) {}

  // The tables put themselves back.
  void PutBack(Map& map) noexcept {
    static_assert(std::is_nothrow_move_assignable_v<FeatureCorrection>);
    map.version_ = version;
    map.keyframes_taken_in_ = keyframes_taken_in;
    map.next_keyframe_ = next_keyframe;
    map.next_point_ = next_point;
    map.next_line_ = next_line;
    map.correction_ = std::move(correction);
  }
  void Keep() {
    keyframes.Keep();
    points.Keep();
    lines.Keep();
    removed_keyframes.Keep();
    merged_points.Keep();
    merged_lines.Keep();
  }

  std::int64_t version, keyframes_taken_in;
  KeyFrameId next_keyframe;
  PointId next_point;
  LineId next_line;
  FeatureCorrection correction;
  IdTable<KeyFrameId, KeyFrame>::Undo keyframes;
  IdTable<PointId, MapPoint>::Undo points;
  IdTable<LineId, MapLine>::Undo lines;
  RemovedKeyFrames::Undo removed_keyframes;
  IdTable<PointId, PointId>::Undo merged_points;
  IdTable<LineId, LineId>::Undo merged_lines;
};

Map::Undo::Undo(Map& map)
    : map_(map), before_(map.keyframes_.undoing() ? nullptr : std::make_unique<Before>(map)) {}

Map::Undo::~Undo() {
  if (before_ && !keep_) before_->PutBack(map_);
}

void Map::Undo::Keep() {
  keep_ = true;
  if (before_) before_->Keep();
}

void Map::Apply(const MapEdit& edit) {
  Undo undo(*this);
  ++version_;
  MapChanger changer{*this};
  for (const MapChange& change : edit) {
    std::visit([&](const auto& c) { changer.Do(c); }, change);
  }
  undo.Keep();
}

namespace {

template <class Id, class T>
void MoveEntries(IdTable<Id, T>& from, IdTable<Id, T>& to) {
  from.ForEach([&](Id id, T& entry) {
    PLUMBLINE_CHECK(!to.contains(id), "two maps use one id");
    to.Insert(id, std::move(entry));
  });
}

}  // namespace

void Map::ShiftNumbers(std::int64_t shift) {
  keyframes_.ForEach([&](KeyFrameId, KeyFrame& keyframe) { keyframe.number += shift; });
  removed_keyframes_.ShiftNumbers(shift);
}

void Map::Absorb(Map other, const Similarity3& this_from_other) {
  edit::MoveKeyFrames motion;
  for (const auto& [id, keyframe] : other.keyframes()) {
    motion.new_from_old.emplace(id, this_from_other);
  }
  Undo undo(*this);
  // KeyFrame::number measures age in keyframes: the growing map has the largest ones.
  if (next_keyframe_ > other.next_keyframe_) {
    ShiftNumbers(other.keyframes_taken_in_);
  } else {
    other.ShiftNumbers(keyframes_taken_in_);
  }
  FeatureCorrection joined = correction_;
  if (joined.lens.border_px() == 0) joined.lens = other.correction_.lens;
  if (!(joined == correction_)) {
    MapChanger{*this}.Do(edit::CorrectFeatures{joined});
    ++version_;
  }
  other.Apply({std::move(motion), edit::CorrectFeatures{joined}});
  MoveEntries(other.keyframes_, keyframes_);
  MoveEntries(other.points_, points_);
  MoveEntries(other.lines_, lines_);
  removed_keyframes_.Absorb(other.removed_keyframes_);
  for (const auto& [gone, kept] : other.merged_points_) merged_points_.Insert(gone, kept);
  for (const auto& [gone, kept] : other.merged_lines_) merged_lines_.Insert(gone, kept);
  keyframes_taken_in_ += other.keyframes_taken_in_;
  next_keyframe_ = std::max(next_keyframe_, other.next_keyframe_);
  ReserveIds(other.next_point_, other.next_line_);
  ++version_;
  undo.Keep();
}

namespace {

template <class LandmarkId, class Landmark>
void CheckLandmarks(const IdTable<LandmarkId, Landmark>& landmarks,
                    const IdTable<KeyFrameId, KeyFrame>& keyframes) {
  for (const auto& [id, landmark] : landmarks) {
    PLUMBLINE_CHECK(!landmark.observations.empty(), "landmark without observations");
    for (const auto& [keyframe_id, feature] : landmark.observations) {
      const auto it = keyframes.find(keyframe_id);
      PLUMBLINE_CHECK(it != keyframes.end(), "observation by a keyframe that is not in the map");
      PLUMBLINE_CHECK(Matches(it->second.frame, id).at(static_cast<std::size_t>(feature)) == id,
                      "keyframe does not know that it shows landmark " + std::to_string(id.value));
    }
  }
}

template <class LandmarkId, class Landmark>
void CheckMatches(KeyFrameId keyframe_id,
                  const std::vector<LandmarkId>& matches,
                  const IdTable<LandmarkId, Landmark>& landmarks) {
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (!matches[i].valid()) continue;
    const auto it = landmarks.find(matches[i]);
    PLUMBLINE_CHECK(it != landmarks.end() && it->second.observations.contains(keyframe_id),
                    "match without observation, landmark " + std::to_string(matches[i].value));
    PLUMBLINE_CHECK(it->second.observations.at(keyframe_id) == static_cast<int>(i),
                    "two features of a keyframe show landmark " + std::to_string(matches[i].value));
  }
}

}  // namespace

void Map::CheckInvariants() const {
  CheckLandmarks(points(), keyframes());
  CheckLandmarks(lines(), keyframes());
  for (const auto& [id, keyframe] : keyframes()) {
    CheckMatches(id, keyframe.frame.points, points());
    CheckMatches(id, keyframe.frame.lines, lines());
  }
}

std::vector<Eigen::Vector3d> PointPositions(const Map& map) {
  std::vector<Eigen::Vector3d> positions;
  for (const auto& [id, point] : map.points()) positions.push_back(point.position);
  return positions;
}

}  // namespace plumbline
