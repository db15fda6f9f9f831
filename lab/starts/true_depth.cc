// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/starts/true_depth.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace plumbline {

using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

TrueDepthOfImage::TrueDepthOfImage(DepthImage depth,
                                   const Camera& raw,
                                   const RectifiedCamera& rectified,
                                   const Quaterniond& rectified_from_raw)
    : depth_(std::move(depth)),
      raw_(raw),
      rectified_(rectified),
      rectified_from_raw_(rectified_from_raw) {}

std::optional<Vector3d> TrueDepthOfImage::PointAt(const Vector2d& px) const {
  constexpr float kSpread = 1.05F;
  const Vector3d ray = rectified_from_raw_.conjugate() * rectified_.Unproject(px);
  const auto raw_px = raw_.Project(ray);
  if (!raw_px) return std::nullopt;
  const auto x = static_cast<int>(std::lround(raw_px->x()));
  const auto y = static_cast<int>(std::lround(raw_px->y()));
  if (x < 1 || y < 1 || x > depth_.width() - 2 || y > depth_.height() - 2) return std::nullopt;
  float low = depth_.at(x, y), high = low;
  for (int v = y - 1; v <= y + 1; ++v) {
    for (int u = x - 1; u <= x + 1; ++u) {
      low = std::min(low, depth_.at(u, v));
      high = std::max(high, depth_.at(u, v));
    }
  }
  if (low <= 0 || high > kSpread * low) return std::nullopt;
  return rectified_from_raw_ * Vector3d(ray / ray.z() * depth_.at(x, y));
}

std::vector<Vector3d> TrueDepthOfImage::Samples() const {
  constexpr int kStep = 24;
  std::vector<Vector3d> samples;
  for (int y = kStep / 2; y < rectified_.height; y += kStep) {
    for (int x = kStep / 2; x < rectified_.width; x += kStep) {
      if (const auto point = PointAt({x, y})) samples.push_back(*point);
    }
  }
  return samples;
}

TrueDepthOfPoints::TrueDepthOfPoints(std::vector<Point> points, const RectifiedCamera& camera)
    : points_(std::move(points)) {
  for (const Point& point : points_) pixels_.push_back(camera.Project(point.position));
}

std::optional<Vector3d> TrueDepthOfPoints::PointAt(const Vector2d& px) const {
  constexpr double kReach = 1.5;  // pixels
  double best = kReach * kReach;
  std::optional<Vector3d> nearest;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double distance = (pixels_[i] - px).squaredNorm();
    if (!points_[i].accurate || distance > best) continue;
    best = distance;
    nearest = points_[i].position;
  }
  return nearest;
}

std::vector<Vector3d> TrueDepthOfPoints::Samples() const {
  std::vector<Vector3d> samples;
  for (const Point& point : points_) samples.push_back(point.position);
  return samples;
}

TrueDepthOfPoints TrueDepthOfStereo(const Features& features,
                                    const RectifiedCamera& stereo,
                                    const Quaterniond& camera_from_stereo,
                                    const RectifiedCamera& camera) {
  constexpr double kRelativeSigma = 0.05;
  std::vector<TrueDepthOfPoints::Point> points;
  for (std::size_t i = 0; i < features.points.size(); ++i) {
    const auto& disparity = features.point_disparity[i];
    if (!disparity || disparity->px <= 0) continue;
    const double depth = stereo.DepthFromDisparity(disparity->px);
    const Vector3d position =
        camera_from_stereo * Vector3d(depth * stereo.Unproject(features.points[i].px));
    if (position.z() <= 0) continue;
    points.push_back({position, disparity->sigma_px <= kRelativeSigma * disparity->px});
  }
  return {std::move(points), camera};
}

}  // namespace plumbline
