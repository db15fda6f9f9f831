// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/snapshot.h"

#include "plumbline/base/error.h"
#include "plumbline/map/covisibility.h"

#include <algorithm>
#include <iterator>
#include <set>

namespace plumbline {
namespace {

constexpr int kNeighboursOfNeighbour = 5;

template <class Element, class LandmarkId>
const Element* FindById(const std::vector<Element>& sorted, LandmarkId id) {
  const auto it = std::lower_bound(
      sorted.begin(), sorted.end(), id, [](const Element& e, LandmarkId i) { return e.id < i; });
  return it != sorted.end() && it->id == id ? &*it : nullptr;
}

std::set<KeyFrameId> Window(const Map& map, KeyFrameId centre, std::size_t max_keyframes) {
  std::set<KeyFrameId> window{centre};
  const auto neighbours = Covisible(map, centre);
  for (const auto& neighbour : neighbours) {
    if (window.size() >= max_keyframes) return window;
    window.insert(neighbour.id);
  }
  for (const auto& neighbour : neighbours) {
    for (const auto& second : ClosestCovisible(map, neighbour.id, kNeighboursOfNeighbour)) {
      if (window.size() >= max_keyframes) return window;
      window.insert(second.id);
    }
  }
  return window;
}

template <class LandmarkId>
void AddValid(const std::vector<LandmarkId>& matches, std::vector<LandmarkId>& ids) {
  std::copy_if(matches.begin(), matches.end(), std::back_inserter(ids), [](LandmarkId id) {
    return id.valid();
  });
}

SnapshotPoint Copy(const MapPoint& p) { return {p, p.id, static_cast<int>(p.observations.size())}; }

SnapshotLine Copy(const MapLine& l) { return {l, l.id, static_cast<int>(l.observations.size())}; }

// Copies each landmark once, in the order of the ids.
template <class LandmarkId, class Element>
void CopyAll(const Map& map, std::vector<LandmarkId>& ids, std::vector<Element>& copies) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  copies.reserve(ids.size());
  for (const LandmarkId id : ids) copies.push_back(Copy(*map.Find(id)));
}

}  // namespace

const SnapshotPoint* MapSnapshot::Find(PointId id) const { return FindById(points, id); }
const SnapshotLine* MapSnapshot::Find(LineId id) const { return FindById(lines, id); }

std::shared_ptr<const MapSnapshot> TakeSnapshot(const Map& map,
                                                KeyFrameId centre,
                                                int max_keyframes,
                                                std::span<const KeyFrameId> earlier) {
  const KeyFrame* reference = map.Find(centre);
  PLUMBLINE_CHECK(reference != nullptr, "snapshot around a keyframe that is not in the map");
  auto snapshot = std::make_shared<MapSnapshot>();
  snapshot->map = map.id();
  snapshot->centre = centre;
  snapshot->correction = map.correction();
  snapshot->reference = std::make_shared<const KeyFrame>(*reference);
  snapshot->places.emplace(centre, map.PlaceOf(centre));
  for (const KeyFrameId id : earlier) snapshot->places.emplace(id, map.PlaceOf(id));
  std::vector<PointId> points;
  std::vector<LineId> lines;
  for (const KeyFrameId id : Window(map, centre, static_cast<std::size_t>(max_keyframes))) {
    const Frame& frame = map.Find(id)->frame;
    snapshot->cam_from_world.emplace(id, frame.cam_from_world);
    AddValid(frame.points, points);
    AddValid(frame.lines, lines);
  }
  CopyAll(map, points, snapshot->points);
  CopyAll(map, lines, snapshot->lines);
  return snapshot;
}

}  // namespace plumbline
