// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/map/frame.h"
#include "plumbline/map/landmarks.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace plumbline {

// Search window and descriptor limits around the projection of a landmark. The defaults are
// tracking's, for a nearly correct pose.
struct ProjectionSearchOptions {
  double point_radius_px = 4;   // at octave 0; grows with the octave
  int point_max_distance = 80;  // Hamming, of 256 bits
  double point_ratio = 0.85;  // largest ratio of the best to the second best distance in the window
  double line_offset_px = 10;  // distance of the feature's midpoint from the projected line
  double line_angle_deg = 8;   // angle between feature and projected line
  int line_max_distance = 80;  // Hamming, of 256 bits
};

// The camera and the size ratio of neighbouring octaves of its features.
struct CameraAndPyramid {
  RectifiedCamera camera;
  double octave_scale = 1.2;
};

// Predicted appearance of a point landmark in an image.
struct ProjectedPoint {
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
  double disparity = 0;
  int octave = 0;
  double scale = 1;  // size of a pixel of the octave in pixels of the full image
  Descriptor descriptor{};
};

// Predicted appearance of a line landmark in an image: the visible part of its interval.
struct ProjectedLine {
  Segment2 segment;
  Descriptor descriptor{};
};

// Returns the projection of a landmark. Returns nullopt if it is behind the camera, outside the
// image, or seen from too different a direction, and for a line of which too little is visible.
std::optional<ProjectedPoint> ProjectPoint(const CameraAndPyramid& imaging,
                                           const Rigid3& cam_from_world,
                                           const PointModel& point);
std::optional<ProjectedLine> ProjectLine(const CameraAndPyramid& imaging,
                                         const Rigid3& cam_from_world,
                                         const LineModel& line);

// Returns the projection of the part of a 3D segment (camera frame) that is in front of the camera
// and inside the image.
std::optional<Segment2> ProjectSegment(const RectifiedCamera& camera, const Segment3& in_camera);

// The best matching feature near the projection of a landmark, with its Hamming distance.
struct ProjectionMatch {
  int feature = 0;
  int distance = 0;
};

// Finds the features of one image that match projected points. Reuses its memory. The image must
// outlive it.
class PointProjectionMatcher {
 public:
  PointProjectionMatcher(const FrameFeatures& image, const ProjectionSearchOptions& options)
      : image_(image), options_(options) {}

  // Returns the best match among features with taken[i] false; nullopt if none is near and similar
  // enough.
  std::optional<ProjectionMatch> Match(const ProjectedPoint& landmark,
                                       const std::vector<bool>& taken);

 private:
  const FrameFeatures& image_;
  ProjectionSearchOptions options_;
  std::vector<int> near_;
};

// Finds the features of one image that match projected lines: near and parallel to the prediction,
// overlapping it, with the same direction. Visits all lines of the image, whose directions it
// computes once.
class LineProjectionMatcher {
 public:
  LineProjectionMatcher(const FrameFeatures& image, const ProjectionSearchOptions& options);

  std::optional<ProjectionMatch> Match(const ProjectedLine& landmark,
                                       const std::vector<bool>& taken) const;

 private:
  struct Place {
    Eigen::Vector2d direction, midpoint;
  };

  const std::vector<LineFeature>& lines_;
  ProjectionSearchOptions options_;
  double min_cosine_;
  std::vector<Place> places_;  // one entry for each line
};

struct LandmarkMatch {
  int landmark = 0;  // index into the projected landmarks
  int feature = 0;
};

// Assigns a feature chosen by several landmarks to the most similar one (ties: the lower index).
// The result is ordered by landmark.
std::vector<LandmarkMatch> OneToOne(const std::vector<std::optional<ProjectionMatch>>& choices,
                                    std::size_t feature_count);

// Matches each projected point with the most similar feature near it, one to one: a feature chosen
// by two landmarks goes to the more similar one (ties: the lower index). Features with taken[i] and
// nullopt entries are skipped. The result is ordered by landmark.
std::vector<LandmarkMatch> MatchProjectedPoints(
    const FrameFeatures& image,
    const std::vector<std::optional<ProjectedPoint>>& landmarks,
    const std::vector<bool>& taken,
    const ProjectionSearchOptions& options);

// Matches each projected line with the most similar feature near it, one to one (see
// MatchProjectedPoints).
std::vector<LandmarkMatch> MatchProjectedLines(
    const FrameFeatures& image,
    const std::vector<std::optional<ProjectedLine>>& landmarks,
    const std::vector<bool>& taken,
    const ProjectionSearchOptions& options);

}  // namespace plumbline
