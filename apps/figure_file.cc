// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/figure_file.h"

#include "plumbline/base/error.h"
#include "plumbline/image/image_codecs.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace plumbline {
namespace {

cv::Scalar Bgr(const Figure::Color& color) {
  return {double(color.b), double(color.g), double(color.r)};
}

std::string ToPng(const Figure& figure) {
  constexpr int kShift = 4;  // fractional bits of OpenCV's fixed-point coordinates
  cv::Mat canvas(figure.height, figure.width, CV_8UC3, cv::Scalar::all(255));
  for (const Figure::Polyline& line : figure.lines) {
    std::vector<cv::Point> points;
    for (const Eigen::Vector2d& p : line.points) {
      points.emplace_back(static_cast<int>(std::lround(p.x() * (1 << kShift))),
                          static_cast<int>(std::lround(p.y() * (1 << kShift))));
    }
    const int width = std::max(1, static_cast<int>(std::lround(line.width)));
    cv::polylines(canvas, points, false, Bgr(line.color), width, cv::LINE_AA, kShift);
  }
  for (const Figure::Text& text : figure.texts) {
    constexpr double kScalePerSize = 1.0 / 28;  // of the font, by eye beside the SVG
    const double scale = text.size * kScalePerSize;
    int base_line = 0;
    const cv::Size size =
        cv::getTextSize(text.text, cv::FONT_HERSHEY_SIMPLEX, scale, 1, &base_line);
    const double shift = text.anchor == Figure::Anchor::kStart    ? 0
                         : text.anchor == Figure::Anchor::kMiddle ? 0.5 * size.width
                                                                  : size.width;
    const cv::Point place(static_cast<int>(std::lround(text.position.x() - shift)),
                          static_cast<int>(std::lround(text.position.y())));
    cv::putText(
        canvas, text.text, place, cv::FONT_HERSHEY_SIMPLEX, scale, Bgr(text.color), 1, cv::LINE_AA);
  }
  return EncodePng(canvas);
}

}  // namespace

void CheckFigureName(const std::filesystem::path& path) {
  const std::filesystem::path extension = path.extension();
  if (extension == ".svg" || extension == ".png") return;
  throw InputError(path.string() + ": expected a file name ending in .svg or .png");
}

std::string FigureBytes(const std::filesystem::path& path, const Figure& figure) {
  CheckFigureName(path);
  return path.extension() == ".svg" ? ToSvg(figure) : ToPng(figure);
}

}  // namespace plumbline
