// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/helper_thread.h"
#include "plumbline/base/options.h"
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
#include <optional>
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
  bool parallel = true;  // work is done in two threads, with the same result
  OrbOptions orb;
  LineDetectionOptions line;
  StereoPointOptions stereo_points;
  StereoLineOptions stereo_lines;
  DepthDisparityOptions depth;
};

// The images of one rectified frame, which the caller keeps alive. `left` is required; of `right`
// and `depth` at most one is used (right first). A valid region may be null: then all pixels count
// as valid.
struct FeatureInput {
  const GrayImage* left = nullptr;
  const GrayImage* right = nullptr;
  const DepthImage* depth = nullptr;
  const ValidRegion* left_valid = nullptr;
  const ValidRegion* right_valid = nullptr;
};

// Measures what the pose of a frame is found from: points and lines of the left image, and for
// stereo and RGB-D the disparities of the points, all rounded to single precision. No line gets a
// right line. Images must have the size of the camera (BugError otherwise). The same input gives
// the same bytes. With options.parallel the work is shared with the helper, or with one that is
// made for the call. `left_pyramid`, where it is given, becomes the pyramid of the left image that
// the points were found in (BuildOrbPyramid); without points it is empty.
Features ExtractFeatures(const RectifiedCamera& camera,
                         const FeatureInput& input,
                         const FeatureOptions& options,
                         HelperThread* helper = nullptr,
                         ImagePyramid* left_pyramid = nullptr);

// Returns where the lines that ExtractFeatures found are in the right image, or would be by the
// depth image (see Features::line_right), rounded to single precision; one entry for each line.
// Only new landmarks need it, and most frames make none. Costs as much as the lines of the left
// image.
std::vector<std::optional<RightLine>> FindRightLines(const RectifiedCamera& camera,
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
