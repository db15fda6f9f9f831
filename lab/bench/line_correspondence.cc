// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/bench/line_correspondence.h"

#include "plumbline/base/random.h"
#include "plumbline/base/units.h"
#include "plumbline/image/opencv_bridge.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

namespace plumbline::bench {
namespace {

cv::Matx33d ToCv(const Eigen::Matrix3d& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}

Eigen::Vector2d Apply(const Eigen::Matrix3d& warp, const Eigen::Vector2d& px) {
  return (warp * px.homogeneous()).hnormalized();
}

}  // namespace

std::optional<std::array<double, 2>> AcrossDistances(const Segment2& expected,
                                                     const Segment2& found) {
  const Eigen::Vector2d d = expected.Direction();
  const Eigen::Vector2d normal(-d.y(), d.x());
  const double t0 = d.dot(found.start - expected.start);
  const double t1 = d.dot(found.end - expected.start);
  if (t1 - t0 <= 0) return std::nullopt;
  const double begin = std::max(0.0, t0);
  const double end = std::min(expected.Length(), t1);
  if (end <= begin) return std::nullopt;
  const auto across = [&](double t) {
    const Eigen::Vector2d on_found = found.start + (t - t0) / (t1 - t0) * (found.end - found.start);
    return normal.dot(on_found - expected.start);
  };
  return std::array{across(begin), across(end)};
}

void FindSame(const std::vector<LineFeature>& found,
              const SameLineLimits& limits,
              std::vector<ExpectedLine>* lines) {
  for (ExpectedLine& line : *lines) {
    if (!line.place) continue;
    for (std::size_t j = 0; j < found.size(); ++j) {
      const Segment2& other = found[j].segment;
      const auto across = AcrossDistances(*line.place, other);
      if (!across || std::abs((*across)[0]) > limits.distance_px ||
          std::abs((*across)[1]) > limits.distance_px ||
          UndirectedAngle(line.place->Direction(), other.Direction()) >
              limits.angle_deg * kDegree) {
        continue;
      }
      if (OverlapRatio(*line.place, other) >= limits.overlap) {
        line.same.push_back(static_cast<int>(j));
      } else {
        line.unclear = true;
      }
    }
  }
}

std::vector<KnownWarp> KnownWarps(int width, int height) {
  const Eigen::Vector2d center(0.5 * width, 0.5 * height);
  const auto about_center = [&](const Eigen::Matrix2d& linear, const Eigen::Vector2d& tilt) {
    Eigen::Matrix3d to_center = Eigen::Matrix3d::Identity();
    to_center.topRightCorner<2, 1>() = -center;
    Eigen::Matrix3d back = Eigen::Matrix3d::Identity();
    back.topRightCorner<2, 1>() = center;
    Eigen::Matrix3d middle = Eigen::Matrix3d::Identity();
    middle.topLeftCorner<2, 2>() = linear;
    middle.bottomLeftCorner<1, 2>() = tilt.transpose() / width;
    return Eigen::Matrix3d(back * middle * to_center);
  };
  const Eigen::Matrix2d same = Eigen::Matrix2d::Identity();
  const Eigen::Vector2d level(0, 0);
  Eigen::Matrix3d shift = Eigen::Matrix3d::Identity();
  shift.topRightCorner<2, 1>() << 7.3, -4.6;
  return {{"turn 4 deg", about_center(Eigen::Rotation2Dd(4 * kDegree).toRotationMatrix(), level)},
          {"scale 0.85", about_center(0.85 * same, level)},
          {"scale 1.15", about_center(1.15 * same, level)},
          {"shift 7.3, -4.6 px", shift},
          {"tilt about y", about_center(same, {0.2, 0})},
          {"tilt about x", about_center(same, {0, -0.2})}};
}

WarpedImage WarpImage(const GrayImage& image,
                      const GrayImage& mask,
                      const KnownWarp& warp,
                      std::uint64_t seed) {
  constexpr double kNoise = 2;
  cv::Mat warped;
  cv::Mat warped_mask;
  const cv::Matx33d matrix = ToCv(warp.warped_from_image);
  cv::warpPerspective(AsMat(image),
                      warped,
                      matrix,
                      {image.width(), image.height()},
                      cv::INTER_CUBIC,
                      cv::BORDER_REPLICATE);
  cv::warpPerspective(
      AsMat(mask), warped_mask, matrix, {image.width(), image.height()}, cv::INTER_LINEAR);
  cv::threshold(warped_mask, warped_mask, 254, 255, cv::THRESH_BINARY);
  WarpedImage result{ToImage<std::uint8_t>(warped), ToImage<std::uint8_t>(warped_mask)};
  Rng rng(seed, "noise of a warped image");
  const std::ptrdiff_t size = std::ptrdiff_t{image.width()} * image.height();
  for (std::ptrdiff_t i = 0; i < size; ++i) {
    std::uint8_t& pixel = result.image.data()[i];
    pixel =
        static_cast<std::uint8_t>(std::clamp(std::lround(pixel + rng.Normal(kNoise)), 0L, 255L));
  }
  return result;
}

std::vector<ExpectedLine> WarpLines(const std::vector<LineFeature>& lines,
                                    const KnownWarp& warp,
                                    const ValidRegion& valid,
                                    double min_length) {
  constexpr double kMarginPx = 6;
  std::vector<ExpectedLine> expected(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Segment2 place{Apply(warp.warped_from_image, lines[i].segment.start),
                         Apply(warp.warped_from_image, lines[i].segment.end)};
    if (valid.Contains(place.start, kMarginPx) && valid.Contains(place.end, kMarginPx) &&
        place.Length() >= min_length) {
      expected[i].place = place;
    }
  }
  return expected;
}

}  // namespace plumbline::bench
