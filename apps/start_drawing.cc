// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/start_drawing.h"

#include "plumbline/image/image_codecs.h"
#include "plumbline/io/atomic_file.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

void Paste(const GrayImage& image, int left, cv::Mat& canvas) {
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      canvas.at<cv::Vec3b>(y, left + x) = cv::Vec3b::all(image.at(x, y));
    }
  }
}

std::optional<Vector2d> PixelIn(const InitialView& view,
                                const Vector3d& point,
                                const RectifiedCamera& camera) {
  const Vector3d p = view.cam_from_world * point;
  if (p.z() <= 0) return std::nullopt;
  return camera.Project(p);
}

cv::Point Rounded(const Vector2d& px, int left) {
  return {left + static_cast<int>(std::lround(px.x())), static_cast<int>(std::lround(px.y()))};
}

// Red at 0 over green to blue at 1.
cv::Scalar Rainbow(double share) {
  const double warm = std::clamp(1 - 2 * share, 0.0, 1.0),
               cold = std::clamp(2 * share - 1, 0.0, 1.0);
  return {255 * cold, 200 * (1 - warm - cold), 255 * warm};
}

std::vector<double> SortedDepths(const InitialMap& map) {
  std::vector<double> depths;
  for (const InitialPoint& point : map.points) {
    depths.push_back((map.views.front().cam_from_world * point.position).z());
  }
  std::sort(depths.begin(), depths.end());
  return depths;
}

void DrawPoints(const InitialMap& map, const RectifiedCamera& camera, cv::Mat& canvas) {
  const std::vector<double> depths = SortedDepths(map);
  for (const InitialPoint& point : map.points) {
    const auto first = PixelIn(map.views.front(), point.position, camera);
    const auto newest = PixelIn(map.views.back(), point.position, camera);
    if (!first || !newest) continue;
    const double depth = (map.views.front().cam_from_world * point.position).z();
    const auto rank = std::lower_bound(depths.begin(), depths.end(), depth) - depths.begin();
    const cv::Scalar color =
        Rainbow(static_cast<double>(rank) / static_cast<double>(depths.size()));
    for (const int left : {0, camera.width}) {
      cv::line(canvas, Rounded(*first, left), Rounded(*newest, left), color, 1, cv::LINE_AA);
    }
    cv::circle(canvas, Rounded(*first, 0), 2, color, cv::FILLED, cv::LINE_AA);
    cv::circle(canvas, Rounded(*newest, camera.width), 2, color, cv::FILLED, cv::LINE_AA);
  }
}

void DrawLines(const InitialMap& map, const RectifiedCamera& camera, cv::Mat& canvas) {
  const cv::Scalar orange(0, 140, 255);
  for (const InitialLine& line : map.lines) {
    int left = 0;
    for (const InitialView* view : {&map.views.front(), &map.views.back()}) {
      const auto start = PixelIn(*view, line.segment.start, camera);
      const auto end = PixelIn(*view, line.segment.end, camera);
      if (start && end && camera.Contains(*start) && camera.Contains(*end)) {
        cv::line(canvas, Rounded(*start, left), Rounded(*end, left), orange, 1, cv::LINE_AA);
      }
      left += camera.width;
    }
  }
}

}  // namespace

void WriteStartDrawing(const InitialMap& map,
                       const RectifiedCamera& camera,
                       const std::filesystem::path& path) {
  const auto &first = map.views.front().frame.image, &newest = map.views.back().frame.image;
  if (!first || !newest) return;
  cv::Mat canvas(camera.height, 2 * camera.width, CV_8UC3, cv::Scalar::all(0));
  Paste(*first, 0, canvas);
  Paste(*newest, camera.width, canvas);
  DrawLines(map, camera, canvas);
  DrawPoints(map, camera, canvas);
  WriteFileAtomically(path, EncodePng(canvas));
}

}  // namespace plumbline
