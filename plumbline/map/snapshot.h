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

// A landmark as tracking needs it.
template <class Model, class Id>
struct SnapshotLandmark : Model {
  Id id;
  int observation_count = 0;
};
using SnapshotPoint = SnapshotLandmark<PointModel, PointId>;
using SnapshotLine = SnapshotLandmark<LineModel, LineId>;

// Immutable copy of the part of the map around one keyframe, which tracking reads while mapping
// goes on.
struct MapSnapshot {
  MapId map;
  KeyFrameId centre;
  FeatureCorrection correction;                 // correction of the features
  std::map<KeyFrameId, Rigid3> cam_from_world;  // poses of the keyframes of the window
  // Poses of the centre and of the centres of earlier snapshots. The tracker's last pose may be
  // relative to any of these, even if the keyframe has left the map meanwhile.
  std::map<KeyFrameId, KeyFramePose> places;
  std::shared_ptr<const KeyFrame> reference;  // the centre, for matching by appearance
  std::vector<SnapshotPoint> points;          // sorted by id
  std::vector<SnapshotLine> lines;            // sorted by id
  bool withdrawn = false;                     // the map proved wrong and must be abandoned

  const SnapshotPoint* Find(PointId id) const;
  const SnapshotLine* Find(LineId id) const;
};

// Largest number of keyframes whose landmarks a frame is tracked against (local map).
inline constexpr int kSnapshotKeyFrames = 40;

// Copies the landmarks seen by `centre`, by its covisible keyframes and by their closest
// neighbours, at most max_keyframes keyframes in all. `earlier`: keyframes that are or were in the
// map and whose poses the tracker may need. The result takes about a megabyte.
std::shared_ptr<const MapSnapshot> TakeSnapshot(const Map& map,
                                                KeyFrameId centre,
                                                int max_keyframes = kSnapshotKeyFrames,
                                                std::span<const KeyFrameId> earlier = {});

}  // namespace plumbline
