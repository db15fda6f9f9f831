// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"
#include "plumbline/map/placement.h"

#include <map>
#include <memory>
#include <span>
#include <vector>

namespace plumbline {

// What tracking needs to know of a landmark.
struct SnapshotPoint : PointModel {
  PointId id;
  int observation_count = 0;
};

struct SnapshotLine : LineModel {
  LineId id;
  int observation_count = 0;
};

// The part of the map around one keyframe as it was at one time. Immutable: the tracker reads it
// while mapping goes on.
struct MapSnapshot {
  MapId map;
  KeyFrameId centre;
  StereoCorrection stereo_correction;           // of disparities
  std::map<KeyFrameId, Rigid3> cam_from_world;  // keyframes of the window
  // Places of the centre and of those that snapshots before were taken around: what the tracker's
  // last pose may hang on, also where the keyframe left the map meanwhile.
  std::map<KeyFrameId, Placement> places;
  std::shared_ptr<const KeyFrame> reference;  // the centre, for matching by appearance
  std::vector<SnapshotPoint> points;          // sorted by id
  std::vector<SnapshotLine> lines;            // sorted by id
  bool withdrawn = false;                     // the map proved wrong and is to be left

  const SnapshotPoint* Find(PointId id) const;
  const SnapshotLine* Find(LineId id) const;
};

// Keyframes whose landmarks a frame is tracked against.
inline constexpr int kSnapshotKeyFrames = 40;

// Copies the landmarks seen by `centre`, by its covisible keyframes and by their closest
// neighbours, at most max_keyframes keyframes in all. `earlier` are keyframes that are or were in
// the map, whose places the tracker may ask for. Order of a megabyte.
std::shared_ptr<const MapSnapshot> TakeSnapshot(const Map& map,
                                                KeyFrameId centre,
                                                int max_keyframes = kSnapshotKeyFrames,
                                                std::span<const KeyFrameId> earlier = {});

}  // namespace plumbline
