// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/gradient.h"

#include "plumbline/image/opencv_bridge.h"

#include <cmath>

#include <opencv2/imgproc.hpp>

namespace plumbline {

GradientImage ComputeGradient(const GrayImage& image, double sigma) {
  PLUMBLINE_CHECK(!image.empty(), "gradient of an empty image");
  GradientImage gradient{Image<std::int16_t>(image.width(), image.height()),
                         Image<std::int16_t>(image.width(), image.height())};
  cv::Mat smooth = AsMat(image);
  if (sigma > 0) {
    cv::Mat blurred;
    const int size = 2 * static_cast<int>(std::ceil(2.5 * sigma)) + 1;
    cv::GaussianBlur(smooth, blurred, {size, size}, sigma, sigma, cv::BORDER_REPLICATE);
    smooth = blurred;
  }
  cv::Mat dx = AsMat(gradient.dx);
  cv::Mat dy = AsMat(gradient.dy);
  cv::Sobel(smooth, dx, CV_16S, 1, 0, 3, 1, 0, cv::BORDER_REPLICATE);
  cv::Sobel(smooth, dy, CV_16S, 0, 1, 3, 1, 0, cv::BORDER_REPLICATE);
  return gradient;
}

}  // namespace plumbline
