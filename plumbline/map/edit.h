// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/sim3.h"
#include "plumbline/map/frame.h"
#include "plumbline/map/landmarks.h"

#include <map>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

namespace plumbline {

// The changes that a map can undergo. Algorithms read a Map and return an Edit; Map::Apply is the
// one place where a map changes.
namespace edit {

// Adds a keyframe with its matches. Matches with landmarks that were merged meanwhile follow the
// merge; those with landmarks that were removed are dropped.
struct AddKeyFrame {
  KeyFrame keyframe;
};
// Removes a keyframe. Frames that refer to it refer to its parent from then on, with the relative
// pose at the time of the removal.
struct RemoveKeyFrame {
  KeyFrameId id;
};
struct SetPose {
  KeyFrameId id;
  Rigid3 cam_from_world;
};
// Moves keyframes, each by a similarity of its own (new from old world), and all that belongs to
// them. A landmark moves with the newest keyframe that shows it. Removed keyframes, and frames
// whose pose is kept relative to a keyframe, follow by themselves (KeyFramePose). Keyframes that
// are not named stay. Where keyframes that see the same landmarks move alike, no reprojection
// changes. Scales other than 1 are for maps of a single camera, since disparities do not change
// with them.
struct MoveKeyFrames {
  std::map<KeyFrameId, Similarity3> new_from_old;
};

// Sets the correction of the features of all keyframes, later ones included.
struct CorrectFeatures {
  FeatureCorrection correction;
  // Features of keyframes of the map that have the correction already (WithCorrection). Those of
  // other keyframes are computed when the edit is applied.
  std::vector<std::pair<KeyFrameId, std::shared_ptr<const FrameFeatures>>> ready = {};
};

// Replaces the features of a keyframe by the same features in the same order, of which some are at
// places that are known better. The map's correction is applied to them.
struct MoveFeatures {
  KeyFrameId id;
  std::shared_ptr<const FrameFeatures> indexed;
};

// Adds a landmark with its observations.
struct AddPoint {
  MapPoint point;
};
struct AddLine {
  MapLine line;
};
struct RemovePoint {
  PointId id;
};
struct RemoveLine {
  LineId id;
};
struct MovePoint {
  PointId id;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
};
struct MoveLine {
  LineId id;
  PluckerLine line;
  double start = 0;
  double end = 0;
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
};
struct AddPointObservation {
  PointId id;
  KeyFrameId keyframe;
  int feature = 0;
};
struct AddLineObservation {
  LineId id;
  KeyFrameId keyframe;
  int feature = 0;
};
struct RemovePointObservation {
  PointId id;
  KeyFrameId keyframe;
};
struct RemoveLineObservation {
  LineId id;
  KeyFrameId keyframe;
};
// Merges two landmarks: observations of `gone` become observations of `kept`, where the keyframe
// does not show `kept` already.
struct MergePoints {
  PointId kept, gone;
};
struct MergeLines {
  LineId kept, gone;
};
// Recomputes the appearance from the observations: descriptor, viewing direction and reference
// scale.
struct RefreshPoint {
  PointId id;
};
struct RefreshLine {
  LineId id;
};
struct ScorePoint {
  PointId id;
  int visible = 0;
  int found = 0;  // both numbers are added to the score
};
struct ScoreLine {
  LineId id;
  int visible = 0;
  int found = 0;
};

}  // namespace edit

using MapChange = std::variant<edit::AddKeyFrame,
                               edit::RemoveKeyFrame,
                               edit::SetPose,
                               edit::MoveKeyFrames,
                               edit::CorrectFeatures,
                               edit::MoveFeatures,
                               edit::AddPoint,
                               edit::AddLine,
                               edit::RemovePoint,
                               edit::RemoveLine,
                               edit::MovePoint,
                               edit::MoveLine,
                               edit::AddPointObservation,
                               edit::AddLineObservation,
                               edit::RemovePointObservation,
                               edit::RemoveLineObservation,
                               edit::MergePoints,
                               edit::MergeLines,
                               edit::RefreshPoint,
                               edit::RefreshLine,
                               edit::ScorePoint,
                               edit::ScoreLine>;

using MapEdit = std::vector<MapChange>;

}  // namespace plumbline
