// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/features/grid.h"
#include "plumbline/features/stereo_correction.h"
#include "plumbline/features/types.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace plumbline {

// The features of one frame with their index by image cell. Never changed once made, so frames,
// keyframes and snapshots share it.
struct IndexedFeatures {
  Features features;
  PointGrid point_grid;
  StereoCorrection correction = {};  // that the disparities and right lines have
};

// The features with another correction; the same where it is the one they have.
std::shared_ptr<const IndexedFeatures> WithCorrection(
    const std::shared_ptr<const IndexedFeatures>& indexed, const StereoCorrection& correction);

// The features with the places of their lines in the right image, as measured (FindRightLines).
std::shared_ptr<const IndexedFeatures> WithRightLines(
    const std::shared_ptr<const IndexedFeatures>& indexed,
    std::vector<std::optional<RightLine>> measured);

// Measured features with their index, for images of this size, given a correction.
std::shared_ptr<const IndexedFeatures> IndexFeatures(const RectifiedCamera& camera,
                                                     Features measured,
                                                     const StereoCorrection& correction = {});

// The features as they were measured, without the correction. Exact for what IndexFeatures and
// WithCorrection made of features in single precision (RoundToSinglePrecision).
Features MeasuredFeatures(const IndexedFeatures& indexed);

// A frame with a pose and its matches: for each feature the landmark it shows, invalid id for none.
struct Frame {
  FrameId id;
  std::int64_t stamp_ns = 0;
  Rigid3 cam_from_world;
  std::shared_ptr<const IndexedFeatures> indexed;
  std::vector<PointId> points;
  std::vector<LineId> lines;

  const Features& features() const { return indexed->features; }
};

// A frame kept in the map. Its features and matches are those of the frame it was made from; the
// matches grow and shrink with the map.
struct KeyFrame {
  KeyFrameId id;
  KeyFrameId parent;  // the keyframe it was tracked against; invalid for the first
  Frame frame;
  // How often a length around the keyframe that was 1 when it came into the map is 1 today: the
  // product of the scales of all motions it took part in (edit::MoveKeyFrames).
  double unit = 1;
  std::int64_t number = 0;  // how many keyframes the map had taken in before; the map counts
  SessionId session{0};     // that its frame is of
};

}  // namespace plumbline
