// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/segment.h"
#include "plumbline/image/image.h"
#include "plumbline/map/frame.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace plumbline {

// Input frame of an initializer. The image is needed by rank1, unless it matches by descriptor.
struct InitializationFrame {
  FrameId id;
  std::int64_t stamp_ns = 0;
  std::shared_ptr<const FrameFeatures> indexed;
  std::shared_ptr<const GrayImage> image;
};

// Observation of a landmark by a feature of a view (an index into InitialMap::views).
struct InitialObservation {
  int view = 0;
  int feature = 0;
  // Pixel of a point in the view, if it is known better than by its feature.
  std::optional<Eigen::Vector2d> px = std::nullopt;
};
// Features of one landmark in several views: at least two, ordered by view.
using FeatureTrack = std::vector<InitialObservation>;

struct InitialPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // in the world
  FeatureTrack observations;
};
struct InitialLine {
  PluckerLine line;  // in the world; directed as its features
  Segment3 segment;  // visible part of the line
  FeatureTrack observations;
};
struct InitialView {
  InitializationFrame frame;
  Rigid3 cam_from_world;
};

// Initial monocular map. The world is the first view's camera; the scale makes the median depth of
// the points there 1.
struct InitialMap {
  // In order of time: the first is the reference, the last the newest frame.
  std::vector<InitialView> views;
  std::vector<InitialPoint> points;
  std::vector<InitialLine> lines;
};

// Triangulates points and lines from views with known poses.
//
// A point must have 0.3 degrees of parallax, lie in front of all its views, agree with them (chi2
// at 95 %) and have a standard deviation of at most 30 % of its depth. A line must have
// interpretation planes at an angle that determines its depth to 10 %, end in front of all views,
// pass through the ends of its segments, and have a depth similar to that of the points. The last
// test is needed because two segments always intersect in some line: with two views only its depth
// reveals a wrong match.
//
//   point_tracks, line_tracks  indices into `views` and the features of the frames there
//   returns                    the map in the world of the views' poses, without failing tracks
//   cost                       O(tracks)
InitialMap TriangulateMap(const RectifiedCamera& camera,
                          std::vector<InitialView> views,
                          std::span<const FeatureTrack> point_tracks,
                          std::span<const FeatureTrack> line_tracks);

// Returns the median depth of the points in the first view; 0 without points.
double MedianDepth(const InitialMap& map);

// Scales poses, points and lines about the world's origin to a median depth of 1. A map without
// points does not change.
void ScaleToMedianDepth(InitialMap& map);

// Bundle adjustment of all poses but the first, and of all points and lines, to all observations.
// Afterwards outlier observations (chi2 at 95 %) and landmarks with fewer than two observations are
// dropped, and the median depth is made 1.
//
//   map   not empty; the first view's camera is the world
//   cost  some milliseconds for three views and 300 points
void AdjustMap(const RectifiedCamera& camera, InitialMap& map);

}  // namespace plumbline
