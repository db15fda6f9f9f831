// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/valid_region.h"

#include "plumbline/image/opencv_bridge.h"

#include <cmath>

#include <opencv2/imgproc.hpp>

namespace plumbline {

ValidRegion::ValidRegion(const GrayImage& mask)
    : width_(mask.width()), height_(mask.height()), distance_(mask.width(), mask.height()) {
  PLUMBLINE_CHECK(!mask.empty(), "empty mask");
  cv::Mat distance;
  cv::distanceTransform(AsMat(mask), distance, cv::DIST_C, 3, CV_32F);
  cv::Mat target = AsMat(distance_);
  distance.convertTo(target, CV_8U);  // saturates at 255
}

bool ValidRegion::Contains(const Eigen::Vector2d& px, double radius) const {
  if (!(px.x() >= radius && px.y() >= radius && px.x() <= width_ - 1 - radius &&
        px.y() <= height_ - 1 - radius)) {
    return false;
  }
  if (distance_.empty()) return true;
  // An invalid pixel at chessboard distance d leaves a clear square of half-width d - 1/2 around
  // the pixel centre. Rounding the position takes up to another 1/2.
  const int x = static_cast<int>(std::lround(px.x()));
  const int y = static_cast<int>(std::lround(px.y()));
  const int distance = distance_.at(x, y);
  return distance == 255 || distance > radius;
}

}  // namespace plumbline
