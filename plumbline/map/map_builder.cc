// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/map_builder.h"

#include "plumbline/base/error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

constexpr int kMaxOctave = 64;

std::vector<PointId>& Matches(Frame& frame, PointId) { return frame.points; }
std::vector<LineId>& Matches(Frame& frame, LineId) { return frame.lines; }

bool IsScale(double scale) { return std::isfinite(scale) && scale > 0; }

bool IsPlaced(const MapPoint& point) { return point.position.allFinite(); }
bool IsPlaced(const MapLine& line) {
  return line.line.moment.allFinite() && line.line.direction.allFinite() &&
         std::isfinite(line.start) && std::isfinite(line.end);
}

bool AreMeasured(const Features& f) {
  const auto octave_fits = [](int octave) { return octave >= 0 && octave < kMaxOctave; };
  return std::all_of(
             f.points.begin(),
             f.points.end(),
             [&](const PointFeature& p) { return p.px.allFinite() && octave_fits(p.octave); }) &&
         std::all_of(f.lines.begin(), f.lines.end(), [&](const LineFeature& l) {
           return l.segment.start.allFinite() && l.segment.end.allFinite() && octave_fits(l.octave);
         });
}

template <class LandmarkId>
bool IsInRange(LandmarkId id, LandmarkId next) {
  return id.valid() && id < next;
}

// Returns true if following `next_of` from any of its keys terminates.
template <class Key, class Value, class Next>
bool ComesToAnEnd(const std::map<Key, Value>& next_of, const Next& next) {
  std::set<Key> ended;
  for (const auto& [start, value] : next_of) {
    std::set<Key> path;
    Key at = start;
    for (auto it = next_of.find(at); it != next_of.end() && !ended.contains(at);
         it = next_of.find(at)) {
      if (!path.insert(at).second) return false;
      at = next(it->second);
    }
    ended.merge(path);
  }
  return true;
}

}  // namespace

MapBuilder::MapBuilder(const MapRecord& record, std::string source)
    : map_(record.id), source_(std::move(source)) {
  CheckRecord(record);
  map_.version_ = record.version;
  map_.keyframes_taken_in_ = record.keyframes_taken_in;
  map_.next_keyframe_ = record.next_keyframe;
  map_.next_point_ = record.next_point;
  map_.next_line_ = record.next_line;
  map_.correction_ = record.correction;
  map_.removed_keyframes_ = RemovedKeyFrames(record.removed_keyframes);
  for (const auto& [gone, kept] : record.merged_points) map_.merged_points_.Insert(gone, kept);
  for (const auto& [gone, kept] : record.merged_lines) map_.merged_lines_.Insert(gone, kept);
}

void MapBuilder::CheckRecord(const MapRecord& record) const {
  const auto is_count = [](std::int64_t count) { return count >= 0 && count <= kMaxBuiltId; };
  if (!is_count(record.id.value) || !is_count(record.next_keyframe.value) ||
      !is_count(record.next_point.value) || !is_count(record.next_line.value)) {
    Fail("an id out of range");
  }
  if (record.version < 0 || !is_count(record.keyframes_taken_in)) Fail("a count out of range");
  if (!record.correction.IsPlausible()) Fail("an implausible correction");
  for (const auto& [id, removed] : record.removed_keyframes) {
    if (!IsInRange(id, record.next_keyframe)) Fail("a removed keyframe that never was");
    if (!IsInRange(removed.parent, record.next_keyframe)) {
      Fail("a removed keyframe beside one that never was");
    }
    if (!IsPose(removed.from_parent.cam_from_keyframe) || !IsScale(removed.from_parent.scale) ||
        !IsScale(removed.scale) || removed.number < 0 ||
        removed.number >= record.keyframes_taken_in) {
      Fail("a removed keyframe without a valid place");
    }
  }
  const auto check_merges = [&](const auto& merged, auto next) {
    for (const auto& [gone, kept] : merged) {
      if (!IsInRange(gone, next) || !IsInRange(kept, next)) Fail("a merge of what never was");
    }
    if (!ComesToAnEnd(merged, [](auto kept) { return kept; })) Fail("merges in a circle");
  };
  check_merges(record.merged_points, record.next_point);
  check_merges(record.merged_lines, record.next_line);
}

void MapBuilder::Add(KeyFrame keyframe) {
  const KeyFrameId id = keyframe.id;
  const auto& others = map_.keyframes();
  if (!IsInRange(id, map_.next_keyframe_) || map_.removed_keyframes_.contains(id) ||
      (!others.empty() && !(others.rbegin()->first < id))) {
    Fail("keyframes out of order");
  }
  Frame& frame = keyframe.frame;
  const Features& f = frame.features();
  PLUMBLINE_CHECK(frame.indexed->correction == map_.correction_, "another correction");
  if (f.points.size() != f.point_disparity.size() || f.lines.size() != f.line_right.size()) {
    Fail("features of unequal counts");
  }
  if (!AreMeasured(f)) Fail("a feature without a position");
  if (!IsPose(frame.cam_from_world) || !IsScale(keyframe.scale)) {
    Fail("a keyframe without a valid pose");
  }
  if (keyframe.number < 0 || keyframe.number >= map_.keyframes_taken_in_) {
    Fail("a count out of range");
  }
  frame.points.assign(f.points.size(), PointId{});
  frame.lines.assign(f.lines.size(), LineId{});
  map_.keyframes_.Insert(id, std::move(keyframe));
}

template <class LandmarkId, class Landmark>
void MapBuilder::AddLandmark(LandmarkId next,
                             Landmark landmark,
                             IdTable<LandmarkId, Landmark>& table) {
  const LandmarkId id = landmark.id;
  if (!IsInRange(id, next) || (!table.empty() && !(table.rbegin()->first < id))) {
    Fail("landmarks out of order");
  }
  if (!IsPlaced(landmark)) Fail("a landmark without a place");
  if (landmark.observations.empty()) Fail("a landmark without observations");
  for (const auto& [keyframe_id, feature] : landmark.observations) {
    KeyFrame* keyframe = map_.keyframes_.Find(keyframe_id);
    auto* matches = keyframe == nullptr ? nullptr : &Matches(keyframe->frame, id);
    if (matches == nullptr || feature < 0 || static_cast<std::size_t>(feature) >= matches->size() ||
        (*matches)[static_cast<std::size_t>(feature)].valid()) {
      Fail("an observation of a feature that is not there or taken");
    }
    (*matches)[static_cast<std::size_t>(feature)] = id;
  }
  table.Insert(id, std::move(landmark));
}

void MapBuilder::Add(MapPoint point) {
  if (map_.merged_points_.contains(point.id)) Fail("a landmark that was merged into another");
  AddLandmark(map_.next_point_, std::move(point), map_.points_);
}

void MapBuilder::Add(MapLine line) {
  if (map_.merged_lines_.contains(line.id)) Fail("a landmark that was merged into another");
  AddLandmark(map_.next_line_, std::move(line), map_.lines_);
}

// Checks that every keyframe has no parent or one that the map knows, and that there is a first
// one.
void MapBuilder::CheckParents() const {
  std::map<KeyFrameId, KeyFrameId> parents;
  for (const auto& [id, removed] : map_.removed_keyframes_.entries()) {
    if (!map_.Knows(removed.parent)) Fail("a removed keyframe beside one that never was");
    parents.emplace(id, removed.parent);
  }
  for (const auto& [id, keyframe] : map_.keyframes()) {
    if (!keyframe.parent.valid()) continue;
    if (!map_.Knows(keyframe.parent)) Fail("a keyframe whose parent never was");
    parents.emplace(id, keyframe.parent);
  }
  if (!ComesToAnEnd(parents, [](KeyFrameId parent) { return parent; })) {
    Fail("keyframes that are their own ancestors");
  }
}

Map MapBuilder::Finish() {
  CheckParents();
  return std::move(map_);
}

void MapBuilder::Fail(const std::string& what) const {
  throw InputError(source_ + ": expected a map that agrees with itself, found " + what);
}

}  // namespace plumbline
