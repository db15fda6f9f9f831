// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/gradient.h"

#include "plumbline/image/opencv_bridge.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace plumbline {
namespace {

// Bilinear value; x in [0, width - 1], y in [0, height - 1].
template <class T>
double Bilinear(const Image<T>& image, double x, double y) {
  const int x0 = static_cast<int>(x);
  const int y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, image.width() - 1);
  const int y1 = std::min(y0 + 1, image.height() - 1);
  const double fx = x - x0;
  const double fy = y - y0;
  const T* top = image.row(y0);
  const T* bottom = image.row(y1);
  return (1 - fy) * ((1 - fx) * top[x0] + fx * top[x1]) +
         fy * ((1 - fx) * bottom[x0] + fx * bottom[x1]);
}

}  // namespace

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

Eigen::Vector2d GradientAt(const GradientImage& gradient, const Eigen::Vector2d& px) {
  if (!(px.x() >= 0 && px.y() >= 0 && px.x() <= gradient.width() - 1 &&
        px.y() <= gradient.height() - 1)) {
    return Eigen::Vector2d::Zero();
  }
  return {Bilinear(gradient.dx, px.x(), px.y()) / kSobelGain,
          Bilinear(gradient.dy, px.x(), px.y()) / kSobelGain};
}

double IntensityAt(const GrayImage& image, const Eigen::Vector2d& px) {
  return Bilinear(image,
                  std::clamp(px.x(), 0.0, static_cast<double>(image.width() - 1)),
                  std::clamp(px.y(), 0.0, static_cast<double>(image.height() - 1)));
}

}  // namespace plumbline
