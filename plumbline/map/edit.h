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

// The possible changes of a map. Algorithms read a Map and return a MapEdit; only Map::Apply
// changes a map.
namespace edit {

// Adds a keyframe with its matches. Matches with landmarks merged meanwhile follow the merge; those
// with removed landmarks are dropped.
struct AddKeyFrame {
  KeyFrame keyframe;
};
// Removes a keyframe. Frames relative to it become relative to its parent, with the relative pose
// at the time of the removal.
struct RemoveKeyFrame {
  KeyFrameId id;
};
struct SetPose {
  KeyFrameId id;
  Rigid3 cam_from_world;
};
// Moves keyframes, each by its own similarity (new from old world), and their landmarks. A landmark
// moves with the newest keyframe that shows it. Removed keyframes, and frames whose pose is
// relative to a keyframe, follow by themselves (KeyFramePose). Other keyframes stay. If keyframes
// that see the same landmarks move alike, no reprojection changes. Scales other than 1 are for maps
// of a single camera, since disparities do not scale.
struct MoveKeyFrames {
  std::map<KeyFrameId, Similarity3> new_from_old;
};

// Sets the correction of the features of all keyframes, including later ones.
struct CorrectFeatures {
  FeatureCorrection correction;
  // Features of keyframes with the correction already applied (WithCorrection). Those of other
  // keyframes are computed in Apply.
  std::vector<std::pair<KeyFrameId, std::shared_ptr<const FrameFeatures>>> ready = {};
};

// Replaces the features of a keyframe by the same features in the same order, some at refined
// positions. The map's correction is applied to them.
struct MoveFeatures {
  KeyFrameId id;
  std::shared_ptr<const FrameFeatures> indexed;
};

// Adds a landmark with its observations.
template <class Landmark>
struct AddLandmark {
  Landmark landmark;
};
using AddPoint = AddLandmark<MapPoint>;
using AddLine = AddLandmark<MapLine>;
template <class Id>
struct Remove {
  Id id;
};
using RemovePoint = Remove<PointId>;
using RemoveLine = Remove<LineId>;
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
template <class Id>
struct AddObservation {
  Id id;
  KeyFrameId keyframe;
  int feature = 0;
};
using AddPointObservation = AddObservation<PointId>;
using AddLineObservation = AddObservation<LineId>;
template <class Id>
struct RemoveObservation {
  Id id;
  KeyFrameId keyframe;
};
using RemovePointObservation = RemoveObservation<PointId>;
using RemoveLineObservation = RemoveObservation<LineId>;
// Merges two landmarks: observations of `gone` become observations of `kept`, except in keyframes
// that already show `kept`.
template <class Id>
struct Merge {
  Id kept, gone;
};
using MergePoints = Merge<PointId>;
using MergeLines = Merge<LineId>;
// Recomputes the appearance from the observations: descriptor, viewing direction and reference
// scale (RefreshAppearance).
template <class Id>
struct Refresh {
  Id id;
};
using RefreshPoint = Refresh<PointId>;
using RefreshLine = Refresh<LineId>;
// Adds to a landmark's tracking score.
template <class Id>
struct Score {
  Id id;
  int visible = 0;
  int found = 0;
};
using ScorePoint = Score<PointId>;
using ScoreLine = Score<LineId>;

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
