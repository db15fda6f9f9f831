// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/viewer/map_comparison.h"

#include "plumbline/map/covisibility.h"

#include <algorithm>
#include <cstddef>

namespace plumbline {
namespace {

// Keyframes that see an established line; as mapping.line_map.min_keyframes has it unless set.
constexpr std::size_t kEstablished = 4;
constexpr float kSmallestMove = 1.0F / 2000;  // relative to the distance from the newest keyframe

ShownPoint PointOf(const Eigen::Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

using ShownSession = std::optional<SessionId>;

ShownPoint ShownOf(const MapPoint& point, const ShownSession&) { return PointOf(point.position); }

ShownLine ShownOf(const MapLine& line, const ShownSession&) {
  const Segment3 interval = line.Interval();
  const ShownPoint a = PointOf(interval.start), b = PointOf(interval.end);
  return {{a[0], a[1], a[2], b[0], b[1], b[2]}, line.observations.size() >= kEstablished};
}

ShownKeyFrame ShownOf(const KeyFrame& keyframe, const ShownSession& session) {
  const bool is_ours = !session || keyframe.session == *session;
  const Rigid3 world_from_cam = Inverse(keyframe.frame.cam_from_world);
  const ShownPoint p = PointOf(world_from_cam.translation);
  const Eigen::Vector4f q = world_from_cam.rotation.coeffs().cast<float>();
  return {
      is_ours ? static_cast<std::uint32_t>(keyframe.frame.id.value) : ShownKeyFrame::kOfAnotherRun,
      {p[0], p[1], p[2], q[0], q[1], q[2], q[3]}};
}

// Returns true if a viewer near `eye` would see the difference.
template <std::size_t kSize>
bool HasMoved(const std::array<float, kSize>& before,
              const std::array<float, kSize>& now,
              const ShownPoint& eye) {
  for (std::size_t at = 0; at < kSize; at += 3) {
    float moved = 0, distance = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float d = now[at + axis] - before[at + axis];
      const float e = now[at + axis] - eye[axis];
      moved += d * d;
      distance += e * e;
    }
    if (moved > kSmallestMove * kSmallestMove * distance) return true;
  }
  return false;
}

bool HasMoved(const ShownLine& before, const ShownLine& now, const ShownPoint& eye) {
  return before.established != now.established || HasMoved(before.ends, now.ends, eye);
}

bool HasMoved(const ShownKeyFrame& before, const ShownKeyFrame& now, const ShownPoint&) {
  return before != now;
}

// Compares a page of a table with its displayed content, `shown`, and updates `shown`. Both are in
// the order of ids.
template <class Table, class T>
void ComparePage(const Table& table,
                 std::size_t page,
                 const ShownSession& session,
                 const ShownPoint& eye,
                 std::vector<std::pair<ShownId, T>>& shown,
                 ShownChanges<T>& changes) {
  std::vector<std::pair<ShownId, T>> next;
  next.reserve(Table::kPage);
  auto before = shown.begin();
  table.ForEachOfPage(page, [&](const auto& id, const auto& entry) {
    const auto name = static_cast<ShownId>(id.value);
    for (; before != shown.end() && before->first < name; ++before) {
      changes.gone.push_back(before->first);
    }
    T now = ShownOf(entry, session);
    const bool known = before != shown.end() && before->first == name;
    if (known && !HasMoved(before->second, now, eye)) {
      now = before->second;
    } else {
      changes.set.emplace_back(name, now);
    }
    if (known) ++before;
    next.emplace_back(name, now);
  });
  for (; before != shown.end(); ++before) changes.gone.push_back(before->first);
  shown = std::move(next);
}

}  // namespace

template <class Table, class T>
ShownChanges<T> MapComparison::CompareTable(const Table& table,
                                            const ShownPoint& eye,
                                            Shown<T>& shown) const {
  ShownChanges<T> changes;
  shown.pages.resize(std::max(shown.pages.size(), table.page_count()));
  for (std::size_t page = 0; page < shown.pages.size(); ++page) {
    const std::uint64_t changed = table.PageChanged(page);
    const bool is_known = changed == 0 ? shown.pages[page].empty() : changed <= shown.changes;
    if (!is_known) ComparePage(table, page, session_, eye, shown.pages[page], changes);
  }
  shown.changes = table.changes();
  return changes;
}

MapChanges MapComparison::Compare(const Atlas& atlas) {
  MapChanges changes;
  if (atlas.empty() || !atlas.active_id().valid()) return changes;
  const Map& map = atlas.active();
  changes.map = map.id();
  if (map_ != map.id()) {
    *this = MapComparison(session_);
    map_ = map.id();
    changes.everything = true;
  }
  ShownPoint eye{};
  if (!map.keyframes().empty()) {
    const Rigid3& pose = map.keyframes().rbegin()->second.frame.cam_from_world;
    eye = PointOf(Inverse(pose).translation);
  }
  changes.points = CompareTable(map.points(), eye, points_);
  changes.lines = CompareTable(map.lines(), eye, lines_);
  changes.keyframes = CompareTable(map.keyframes(), eye, keyframes_);
  const auto& keyframes = map.keyframes();
  for (auto it = keyframes.upper_bound(newest_); it != keyframes.end(); ++it) {
    without_neighbours_.push_back(it->first);
    newest_ = it->first;
  }
  AddEdges(map, changes);
  return changes;
}

void MapComparison::AddEdges(const Map& map, MapChanges& changes) {
  for (std::size_t n = 0; n < kNeighboursAtOnce && !without_neighbours_.empty(); ++n) {
    const KeyFrameId id = without_neighbours_.back();
    without_neighbours_.pop_back();
    if (map.Find(id) == nullptr) continue;
    int told = 0;
    for (const CovisibleKeyFrame& other : Covisible(map, id)) {
      if (other.id > id) continue;
      changes.edges.emplace_back(static_cast<ShownId>(id.value),
                                 static_cast<ShownId>(other.id.value));
      if (++told == kNeighbours) break;
    }
  }
}

}  // namespace plumbline
