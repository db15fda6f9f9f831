// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/base/parallel.h"
#include "plumbline/features/depth_disparity.h"
#include "plumbline/features/line_detection.h"
#include "plumbline/features/match_lines.h"
#include "plumbline/features/match_points.h"
#include "plumbline/features/orb.h"
#include "plumbline/features/types.h"
#include "plumbline/features/valid_region.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/image/image.h"
#include "plumbline/image/pyramid.h"

#include <cstdint>
#include <vector>

namespace plumbline {

// The version of the features. It is increased whenever the code measures or describes features in
// a way that makes those of earlier versions match less well.
inline constexpr std::int32_t kFeatureFormat = 1;

struct FeatureOptions {
  bool points = true;
  int point_count = 1000;
  bool lines = true;
  int line_count = 200;
  LineDetector line_detector = LineDetector::kDrawing;
  bool parallel = true;  // uses two threads, with the same result
  OrbOptions orb;
  LineDetectionOptions line;
  StereoPointOptions stereo_points;
  StereoLineOptions stereo_lines;
  DepthDisparityOptions depth;
};

// The images of one rectified frame; the caller owns them. `left` is required; of `right` and
// `depth` at most one is used (right first). A null valid region means that all pixels are valid.
struct FeatureInput {
  const GrayImage* left = nullptr;
  const GrayImage* right = nullptr;
  const DepthImage* depth = nullptr;
  const ValidRegion* left_valid = nullptr;
  const ValidRegion* right_valid = nullptr;
};

// Extracts the features for pose estimation: points and lines of the left image, and for stereo and
// RGB-D the disparities of the points, all rounded to single precision. Right lines stay empty.
// Images must have the size of the camera (BugError otherwise). The same input gives the same
// bytes. With options.parallel the work is shared with `helper`, or with a thread started for the
// call. `left_pyramid`, if not null, becomes the pyramid of the left image for the points
// (BuildOrbPyramid); without points it is empty.
Features ExtractFeatures(const RectifiedCamera& camera,
                         const FeatureInput& input,
                         const FeatureOptions& options,
                         HelperThread* helper = nullptr,
                         ImagePyramid* left_pyramid = nullptr);

// Returns the right-image positions of the lines found by ExtractFeatures, measured in the right
// image or predicted from the depth image (see Features::line_right), rounded to single precision;
// one entry for each line. Only new landmarks need them, and most frames make none. Costs as much
// as the lines of the left image.
OptionalList<MeasuredSegment> FindRightLines(const RectifiedCamera& camera,
                                             const FeatureInput& input,
                                             const FeatureOptions& options,
                                             const std::vector<LineFeature>& lines);

template <class Visitor>
void VisitFields(Visitor&& visit, FeatureOptions& o) {
  visit("points", o.points, "use points");
  visit("point_count", o.point_count, "points per image", Range{0, 20000});
  visit("lines", o.lines, "use lines");
  visit("line_count", o.line_count, "lines per image", Range{0, 5000});
  visit("line_detector", o.line_detector, "detector of line segments");
  visit("parallel", o.parallel, "features in two threads");
  visit("orb", o.orb, "corners and their descriptors");
  visit("line", o.line, "line segments");
  visit("stereo_points", o.stereo_points, "disparities of points from the right image");
  visit("stereo_lines", o.stereo_lines, "matching of lines between left and right");
  visit("depth", o.depth, "disparities from depth images");
}

}  // namespace plumbline
