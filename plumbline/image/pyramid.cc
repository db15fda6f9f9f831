// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/pyramid.h"

#include "plumbline/base/elementary.h"
#include "plumbline/image/opencv_bridge.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace plumbline {

ImagePyramid BuildPyramid(const GrayImage& image, int levels, double factor, int min_side) {
  PLUMBLINE_CHECK(!image.empty(), "pyramid of an empty image");
  PLUMBLINE_CHECK(levels >= 1 && factor > 1, "levels >= 1 and factor > 1");
  ImagePyramid pyramid;
  pyramid.reserve(static_cast<std::size_t>(levels));
  pyramid.push_back({image, Eigen::Vector2d::Ones()});
  for (int level = 1; level < levels; ++level) {
    const double shrink = math::Pow(factor, level);
    const int width = static_cast<int>(std::lround(image.width() / shrink));
    const int height = static_cast<int>(std::lround(image.height() / shrink));
    if (std::min(width, height) < min_side) break;
    PyramidLevel next;
    next.image = GrayImage(width, height);
    cv::Mat target = AsMat(next.image);
    cv::resize(AsMat(pyramid.back().image), target, target.size(), 0, 0, cv::INTER_LINEAR);
    next.scale = {static_cast<double>(image.width()) / width,
                  static_cast<double>(image.height()) / height};
    pyramid.push_back(std::move(next));
  }
  return pyramid;
}

}  // namespace plumbline
