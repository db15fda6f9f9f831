// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/map/frame.h"
#include "plumbline/map/landmarks.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace plumbline {

struct ProjectionSearchOptions {
  double point_radius_px = 4;      // at octave 0; grows with the octave
  int point_max_distance = 80;     // Hamming, of 256 bits
  double point_ratio = 0.85;       // best / second best in the window
  double max_view_angle_deg = 60;  // between the usual and the present viewing direction
  double line_offset_px = 10;      // midpoint of the feature from the projected line
  double line_angle_deg = 8;       // between feature and projected line
  int line_max_distance = 80;      // Hamming, of 256 bits
  double line_min_length_px = 20;  // visible part of a projected line
};

template <class Visitor>
void VisitFields(Visitor&& visit, ProjectionSearchOptions& o) {
  visit("point_radius_px", o.point_radius_px, "search radius of a point [px]", Range{0.5, 200});
  visit("point_max_distance", o.point_max_distance, "largest Hamming distance", Range{0, 256});
  visit(
      "point_ratio", o.point_ratio, "largest ratio of best to second best distance", Range{0.1, 1});
  visit("max_view_angle_deg", o.max_view_angle_deg, "largest change of view [deg]", Range{1, 180});
  visit("line_offset_px", o.line_offset_px, "search distance across a line [px]", Range{0.5, 200});
  visit("line_angle_deg", o.line_angle_deg, "largest angle to the prediction [deg]", Range{1, 90});
  visit("line_max_distance", o.line_max_distance, "largest Hamming distance", Range{0, 256});
  visit("line_min_length_px", o.line_min_length_px, "shortest visible part [px]", Range{1, 1000});
}

// The camera and the size ratio of neighbouring octaves of its features.
struct ImagingModel {
  RectifiedCamera camera;
  double octave_scale = 1.2;
};

// A point landmark as it should appear in an image.
struct ProjectedPoint {
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
  double disparity = 0;
  int octave = 0;
  double scale = 1;  // of the octave against the full image
  Descriptor descriptor{};
};

// A line landmark as it should appear in an image: the visible part of its interval.
struct ProjectedLine {
  Segment2 segment;
  Descriptor descriptor{};
};

// Where a landmark should appear; nullopt when it is behind the camera, outside the image, or seen
// from too different a side.
std::optional<ProjectedPoint> ProjectPoint(const ImagingModel& imaging,
                                           const Rigid3& cam_from_world,
                                           const PointModel& point,
                                           const ProjectionSearchOptions& options);
std::optional<ProjectedLine> ProjectLine(const ImagingModel& imaging,
                                         const Rigid3& cam_from_world,
                                         const LineModel& line,
                                         const ProjectionSearchOptions& options);

// The part of a 3D segment (camera frame) in front of the camera and inside the image, projected.
std::optional<Segment2> ProjectSegment(const RectifiedCamera& camera, const Segment3& in_camera);

// Of the features near the place of a landmark the one that looks most like it, and how much so
// (Hamming distance).
struct FeatureChoice {
  int feature = 0;
  int distance = 0;
};

// Chooses features of one image for points. Keeps what it allocates; the image must outlive it.
class PointChooser {
 public:
  PointChooser(const IndexedFeatures& image, const ProjectionSearchOptions& options)
      : image_(image), options_(options) {}

  // Among those with taken[i] false; nullopt where none is near and alike enough.
  std::optional<FeatureChoice> Choose(const ProjectedPoint& landmark,
                                      const std::vector<bool>& taken);

 private:
  const IndexedFeatures& image_;
  ProjectionSearchOptions options_;
  std::vector<int> near_;
};

// The same for lines: near and parallel to the prediction, overlapping it, same direction. Looks at
// all lines of the image, whose directions it computes once.
class LineChooser {
 public:
  LineChooser(const IndexedFeatures& image, const ProjectionSearchOptions& options);

  std::optional<FeatureChoice> Choose(const ProjectedLine& landmark,
                                      const std::vector<bool>& taken) const;

 private:
  struct Place {
    Eigen::Vector2d direction, midpoint;
  };

  const std::vector<LineFeature>& lines_;
  ProjectionSearchOptions options_;
  double min_cosine_;
  std::vector<Place> places_;  // of the lines
};

struct LandmarkMatch {
  int landmark = 0;  // index into the projected landmarks
  int feature = 0;
};

// Of landmarks that chose the same feature the most similar gets it (ties: the lower index). Result
// ordered by landmark.
std::vector<LandmarkMatch> OneToOne(const std::vector<std::optional<FeatureChoice>>& choices,
                                    std::size_t feature_count);

// Matches each projected point with the most similar feature near it, one to one: of two landmarks
// that want a feature the more similar gets it (ties: the lower index). Features with taken[i] are
// left out. nullopt entries are skipped. Result ordered by landmark.
std::vector<LandmarkMatch> MatchProjectedPoints(
    const IndexedFeatures& image,
    const std::vector<std::optional<ProjectedPoint>>& landmarks,
    const std::vector<bool>& taken,
    const ProjectionSearchOptions& options);

// The same for lines.
std::vector<LandmarkMatch> MatchProjectedLines(
    const IndexedFeatures& image,
    const std::vector<std::optional<ProjectedLine>>& landmarks,
    const std::vector<bool>& taken,
    const ProjectionSearchOptions& options);

}  // namespace plumbline
