// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/keyframe_pose.h"
#include "plumbline/map/map.h"

#include <map>
#include <memory>
#include <span>
#include <vector>

namespace plumbline {

// What tracking needs to know about a landmark.
struct SnapshotPoint : PointModel {
  PointId id;
  int observation_count = 0;
};

struct SnapshotLine : LineModel {
  LineId id;
  int observation_count = 0;
};

// The part of the map around one keyframe at one time. It is immutable: the tracker reads it while
// mapping goes on.
struct MapSnapshot {
  MapId map;
  KeyFrameId centre;
  FeatureCorrection correction;                 // correction of the features
  std::map<KeyFrameId, Rigid3> cam_from_world;  // poses of the keyframes of the window
  // Places of the centre and of the centres of earlier snapshots. The tracker's last pose may refer
  // to one of these, even where the keyframe has left the map meanwhile.
  std::map<KeyFrameId, KeyFramePose> places;
  std::shared_ptr<const KeyFrame> reference;  // the centre, for matching by appearance
  std::vector<SnapshotPoint> points;          // sorted by id
  std::vector<SnapshotLine> lines;            // sorted by id
  bool withdrawn = false;                     // the map proved wrong and is to be left

  const SnapshotPoint* Find(PointId id) const;
  const SnapshotLine* Find(LineId id) const;
};

// Largest number of keyframes whose landmarks a frame is tracked against.
inline constexpr int kSnapshotKeyFrames = 40;

// Copies the landmarks seen by `centre`, by its covisible keyframes and by their closest
// neighbours, at most max_keyframes keyframes in all. `earlier` are keyframes that are or were in
// the map, and whose places the tracker may ask for. The result takes about a megabyte.
std::shared_ptr<const MapSnapshot> TakeSnapshot(const Map& map,
                                                KeyFrameId centre,
                                                int max_keyframes = kSnapshotKeyFrames,
                                                std::span<const KeyFrameId> earlier = {});

}  // namespace plumbline
