// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/box_filter.h"

#include "plumbline/image/opencv_bridge.h"

#include <opencv2/imgproc.hpp>

namespace plumbline {

GrayImage BoxFiltered(const GrayImage& image, int size) {
  PLUMBLINE_CHECK(size >= 1, "size of a box filter");
  GrayImage result(image.width(), image.height());
  cv::Mat out = AsMat(result);
  cv::blur(AsMat(image), out, {size, size}, {-1, -1}, cv::BORDER_REPLICATE);
  return result;
}

}  // namespace plumbline
