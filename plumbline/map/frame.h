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
#include <vector>

namespace plumbline {

// The features of one frame with their index by image cell. Immutable, so that frames, keyframes
// and snapshots share them.
struct FrameFeatures {
  Features features;
  PointGrid point_grid;
  FeatureCorrection correction = {};  // correction applied to the features

  // Writes the indices of the points with |dx| <= radius.x and |dy| <= radius.y into a vector that
  // is reused (PointGrid::InWindow).
  void PointsInWindow(const Eigen::Vector2d& center,
                      const Eigen::Vector2d& radius,
                      std::vector<int>* out) const {
    const auto place_of = [&](int i) -> const auto& {
      return features.points[static_cast<std::size_t>(i)].px;
    };
    point_grid.InWindow(center, radius, place_of, out);
  }
};

// Returns the features with another correction; the same object if they already have it.
std::shared_ptr<const FrameFeatures> WithCorrection(
    const std::shared_ptr<const FrameFeatures>& indexed, const FeatureCorrection& correction);

// Returns the features with the measured positions of their lines in the right image
// (FindRightLines).
std::shared_ptr<const FrameFeatures> WithRightLines(
    const std::shared_ptr<const FrameFeatures>& indexed, OptionalList<MeasuredSegment> measured);

// Returns measured features with a correction applied and indexed, for images of the camera's size.
std::shared_ptr<const FrameFeatures> IndexFeatures(const RectifiedCamera& camera,
                                                   Features measured,
                                                   const FeatureCorrection& correction = {});

// Returns the features as measured, without the correction. Exact for results of IndexFeatures and
// WithCorrection on features in single precision (RoundToSinglePrecision).
Features MeasuredFeatures(const FrameFeatures& indexed);

// A frame with a pose and its matches: the landmark of each feature; an invalid id for none.
struct Frame {
  FrameId id;
  std::int64_t stamp_ns = 0;
  Rigid3 cam_from_world;
  std::shared_ptr<const FrameFeatures> indexed;
  std::vector<PointId> points;
  std::vector<LineId> lines;

  const Features& features() const { return indexed->features; }
};

// A frame kept in the map. Its features are immutable; its matches change with the map.
struct KeyFrame {
  KeyFrameId id;
  KeyFrameId parent;  // keyframe it was tracked against; invalid for the first
  Frame frame;
  // Scale of the map around the keyframe relative to that at its insertion: the product of the
  // scales of all its motions (edit::MoveKeyFrames).
  double scale = 1;
  // Number of keyframes inserted into the map before it; set by the map.
  std::int64_t number = 0;
  SessionId session{0};  // session of its frame
};

}  // namespace plumbline
