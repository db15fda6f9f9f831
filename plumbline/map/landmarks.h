// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/features/types.h"
#include "plumbline/geometry/plucker.h"
#include "plumbline/map/observations.h"

#include <map>

#include <Eigen/Core>

namespace plumbline {

// Model of a point for search in images: position and appearance.
struct PointModel {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();        // in the world
  Eigen::Vector3d view_direction = Eigen::Vector3d::Zero();  // mean unit vector from the cameras
  // Distance from the camera at which the point appears in octave reference_octave.
  double reference_distance = 0;
  int reference_octave = 0;  // octave at reference_distance
  Descriptor descriptor{};   // the most typical descriptor of its observations
};

// Model of a line for search in images. Optimization works on the infinite line; the interval
// [start, end] of parameters along it (PluckerLine::PointAt) is for search and display only.
struct LineModel {
  PluckerLine line;  // in the world; direction by its brighter side (LineFeature)
  double start = 0;
  double end = 0;
  // Information matrix of the orthonormal tangent, with fixed poses.
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  Eigen::Vector3d view_direction = Eigen::Vector3d::Zero();
  Descriptor descriptor{};

  Segment3 Interval() const { return {line.PointAt(start), line.PointAt(end)}; }
};

// Number of frames in which the tracker expected a landmark, and in which it found it.
struct TrackingScore {
  int visible = 1;
  int found = 1;

  double Ratio() const { return static_cast<double>(found) / visible; }
};

// Scores accumulated over several frames.
struct TrackingScores {
  std::map<PointId, TrackingScore> points;
  std::map<LineId, TrackingScore> lines;
};

struct MapPoint : PointModel {
  PointId id;
  KeyFrameId created_by;
  Observations observations;
  TrackingScore score;
};

struct MapLine : LineModel {
  LineId id;
  KeyFrameId created_by;
  Observations observations;
  TrackingScore score;
};

}  // namespace plumbline
