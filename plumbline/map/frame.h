// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/features/feature_correction.h"
#include "plumbline/features/grid.h"
#include "plumbline/features/types.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace plumbline {

// The features of one frame with their index by image cell. They are never changed once made, so
// that frames, keyframes and snapshots share them.
struct FrameFeatures {
  Features features;
  PointGrid point_grid;
  FeatureCorrection correction = {};  // the correction that the features have
};

// Returns the features with another correction; the same object where they have it already.
std::shared_ptr<const FrameFeatures> WithCorrection(
    const std::shared_ptr<const FrameFeatures>& indexed, const FeatureCorrection& correction);

// Returns the features with the places of their lines in the right image, as measured
// (FindRightLines).
std::shared_ptr<const FrameFeatures> WithRightLines(
    const std::shared_ptr<const FrameFeatures>& indexed,
    std::vector<std::optional<RightLine>> measured);

// Returns measured features with a correction and their index, for images of the camera's size.
std::shared_ptr<const FrameFeatures> IndexFeatures(const RectifiedCamera& camera,
                                                   Features measured,
                                                   const FeatureCorrection& correction = {});

// Returns the features as they were measured, without the correction. The result is exact for what
// IndexFeatures and WithCorrection made of features in single precision (RoundToSinglePrecision).
Features MeasuredFeatures(const FrameFeatures& indexed);

// A frame with a pose and its matches: the landmark that each feature shows, an invalid id for
// none.
struct Frame {
  FrameId id;
  std::int64_t stamp_ns = 0;
  Rigid3 cam_from_world;
  std::shared_ptr<const FrameFeatures> indexed;
  std::vector<PointId> points;
  std::vector<LineId> lines;

  const Features& features() const { return indexed->features; }
};

// A frame that is kept in the map. Its features are those of the frame it was made from; its
// matches change with the map.
struct KeyFrame {
  KeyFrameId id;
  KeyFrameId parent;  // the keyframe it was tracked against; invalid for the first
  Frame frame;
  // The present length of what had the length 1 around the keyframe when it came into the map: the
  // product of the scales of all motions it took part in (edit::MoveKeyFrames).
  double scale = 1;
  // Number of keyframes that the map had taken in before; the map sets it.
  std::int64_t number = 0;
  SessionId session{0};  // session of its frame
};

}  // namespace plumbline
