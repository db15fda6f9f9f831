// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/extractor.h"

#include "plumbline/base/error.h"
#include "plumbline/base/parallel.h"
#include "plumbline/features/lbd.h"
#include "plumbline/features/single_precision.h"

#include <array>

namespace plumbline {
namespace {

// The features of one image by itself.
struct SingleView {
  ImagePyramid pyramid;
  std::vector<PointFeature> points;
  std::vector<LineFeature> lines;
};

// Builds only the pyramid: points need no more of the right image, which is searched for those of
// the left one.
void BuildPyramidOnly(const GrayImage& image,
                      const ValidRegion& /*region*/,
                      const FeatureOptions& options,
                      SingleView& view) {
  if (options.points) view.pyramid = BuildOrbPyramid(image, options.orb);
}

void ExtractPoints(const GrayImage& image,
                   const ValidRegion& region,
                   const FeatureOptions& options,
                   SingleView& view) {
  BuildPyramidOnly(image, region, options, view);
  if (options.points) {
    view.points = ExtractOrb(view.pyramid, region, options.point_count, options.orb);
  }
}

void ExtractLines(const GrayImage& image,
                  const ValidRegion& region,
                  const FeatureOptions& options,
                  SingleView& view) {
  if (!options.lines) return;
  const GradientImage gradient = ComputeGradient(image, kLineBlurPx);
  view.lines =
      DetectLines(image, gradient, region, options.line_detector, options.line_count, options.line);
  DescribeLines(gradient, &view.lines);
}

// Returns the valid region that the caller gave, or the whole image.
const ValidRegion& RegionOf(const ValidRegion* given, const ValidRegion& whole) {
  return given ? *given : whole;
}

// Extracts the left view and, for stereo, the parts of the right one that its points need.
std::array<SingleView, 2> ExtractViews(const FeatureInput& input,
                                       const FeatureOptions& options,
                                       HelperThread* helper) {
  std::array<SingleView, 2> views;
  const ValidRegion whole(input.left->width(), input.left->height());
  const std::array tasks{ExtractPoints, ExtractLines, BuildPyramidOnly};
  ParallelFor(input.right ? 3 : 2, helper, [&](int task) {
    const bool left = task < 2;
    const GrayImage& image = left ? *input.left : *input.right;
    const ValidRegion* valid = left ? input.left_valid : input.right_valid;
    tasks[static_cast<std::size_t>(task)](
        image, RegionOf(valid, whole), options, views[left ? 0 : 1]);
  });
  return views;
}

std::vector<std::optional<Disparity>> MatchRightPoints(const RectifiedCamera& camera,
                                                       const FeatureInput& input,
                                                       const std::array<SingleView, 2>& views,
                                                       const FeatureOptions& options,
                                                       HelperThread* helper) {
  const auto& [left, right] = views;
  const ValidRegion whole(camera.width, camera.height);
  return MatchStereoPoints(camera,
                           left.points,
                           {left.pyramid, right.pyramid, RegionOf(input.right_valid, whole)},
                           options.stereo_points,
                           helper);
}

std::vector<std::optional<MeasuredSegment>> MatchRightLines(const RectifiedCamera& camera,
                                                            const FeatureInput& input,
                                                            const FeatureOptions& options,
                                                            const std::vector<LineFeature>& lines) {
  const ValidRegion whole(camera.width, camera.height);
  SingleView right;
  ExtractLines(*input.right, RegionOf(input.right_valid, whole), options, right);
  return MatchStereoLines(camera, lines, right.lines, options.stereo_lines);
}

void CheckInput(const RectifiedCamera& camera, const FeatureInput& input) {
  const auto fits = [&](const auto* item) {
    return !item || (item->width() == camera.width && item->height() == camera.height);
  };
  PLUMBLINE_CHECK(input.left && !input.left->empty(), "a left image");
  PLUMBLINE_CHECK(fits(input.left) && fits(input.right) && fits(input.depth), "size of the images");
  PLUMBLINE_CHECK(fits(input.left_valid) && fits(input.right_valid), "size of the valid regions");
}

}  // namespace

Features ExtractFeatures(const RectifiedCamera& camera,
                         const FeatureInput& input,
                         const FeatureOptions& options,
                         HelperThread* helper,
                         ImagePyramid* left_pyramid) {
  CheckInput(camera, input);
  std::optional<HelperThread> made;
  if (!options.parallel) {
    helper = nullptr;
  } else if (helper == nullptr) {
    helper = &made.emplace();
  }
  std::array<SingleView, 2> views = ExtractViews(input, options, helper);
  SingleView& left = views[0];
  Features features;
  if (input.right) {
    features.point_disparity = MatchRightPoints(camera, input, views, options, helper);
  } else if (input.depth) {
    features.point_disparity = PointDisparities(camera, *input.depth, left.points, options.depth);
  }
  if (left_pyramid != nullptr) *left_pyramid = std::move(left.pyramid);
  features.points = std::move(left.points);
  features.lines = std::move(left.lines);
  features.point_disparity.resize(features.points.size());
  features.line_right.resize(features.lines.size());
  RoundToSinglePrecision(features);
  return features;
}

OptionalList<MeasuredSegment> FindRightLines(const RectifiedCamera& camera,
                                             const FeatureInput& input,
                                             const FeatureOptions& options,
                                             const std::vector<LineFeature>& lines) {
  CheckInput(camera, input);
  if (lines.empty()) return {};
  Features found;
  if (input.right) {
    found.line_right = MatchRightLines(camera, input, options, lines);
  } else if (input.depth) {
    found.line_right = VirtualRightLines(camera, *input.depth, lines, options.depth);
  }
  found.line_right.resize(lines.size());
  RoundToSinglePrecision(found);
  return std::move(found.line_right);
}

}  // namespace plumbline
