// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/extractor.h"

#include "plumbline/base/error.h"
#include "plumbline/features/lbd.h"

#include <future>

namespace plumbline {
namespace {

// What one image gives by itself.
struct SingleView {
  ImagePyramid pyramid;
  std::vector<PointFeature> points;
  std::vector<LineFeature> lines;
};

SingleView ExtractView(const GrayImage& image,
                       const ValidRegion* valid,
                       const FeatureOptions& options) {
  const ValidRegion whole(image.width(), image.height());
  const ValidRegion& region = valid ? *valid : whole;
  SingleView view;
  if (options.points) {
    view.pyramid = BuildOrbPyramid(image, options.orb);
    view.points = ExtractOrb(view.pyramid, region, options.point_count, options.orb);
  }
  if (options.lines) {
    const GradientImage gradient = ComputeGradient(image, kLineBlurPx);
    view.lines = DetectLines(
        image, gradient, region, options.line_detector, options.line_count, options.line);
    DescribeLines(gradient, &view.lines);
  }
  return view;
}

void MatchRight(const RectifiedCamera& camera,
                const SingleView& left,
                const SingleView& right,
                const FeatureOptions& options,
                Features* features) {
  features->point_disparity = MatchStereoPoints(
      camera, {left.points, left.pyramid}, {right.points, right.pyramid}, options.stereo_points);
  features->line_right = MatchStereoLines(camera, left.lines, right.lines, options.stereo_lines);
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
                         const FeatureOptions& options) {
  CheckInput(camera, input);
  std::future<SingleView> right;
  if (input.right) {
    const auto policy = options.parallel ? std::launch::async : std::launch::deferred;
    right = std::async(
        policy, ExtractView, std::cref(*input.right), input.right_valid, std::cref(options));
  }
  SingleView left = ExtractView(*input.left, input.left_valid, options);
  Features features;
  if (input.right) {
    MatchRight(camera, left, right.get(), options, &features);
  } else if (input.depth) {
    features.point_disparity = PointDisparities(camera, *input.depth, left.points, options.depth);
    features.line_right = VirtualRightLines(camera, *input.depth, left.lines, options.depth);
  }
  features.points = std::move(left.points);
  features.lines = std::move(left.lines);
  features.point_disparity.resize(features.points.size());
  features.line_right.resize(features.lines.size());
  return features;
}

}  // namespace plumbline
