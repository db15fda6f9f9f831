// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/resample.h"

#include "plumbline/base/error.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace plumbline {

Orientation OrientationOfExif(int number) {
  constexpr std::array<Orientation, 8> kOrientations = {{{false, false, false},
                                                         {false, true, false},
                                                         {false, true, true},
                                                         {false, false, true},
                                                         {true, false, false},
                                                         {true, true, false},
                                                         {true, true, true},
                                                         {true, false, true}}};
  if (number < 1 || number > 8) return {};
  return kOrientations[static_cast<std::size_t>(number) - 1];
}

Orientation ClockwiseTurn(int degrees) {
  PLUMBLINE_CHECK(degrees >= 0 && degrees % 90 == 0, "a turn by quarters");
  constexpr std::array<int, 4> kExif = {1, 6, 3, 8};
  return OrientationOfExif(kExif[static_cast<std::size_t>(degrees / 90 % 4)]);
}

Orientation Inverse(const Orientation& orientation) {
  Orientation inverse = orientation;
  if (orientation.transpose) std::swap(inverse.flip_x, inverse.flip_y);
  return inverse;
}

std::string Describe(const Orientation& orientation) {
  if (orientation.IsIdentity()) return "as stored";
  Orientation turn = orientation;
  if (turn.Mirrors()) turn.flip_x = !turn.flip_x;  // mirrored left to right after the turn
  int degrees = 0;
  while (ClockwiseTurn(degrees) != turn) degrees += 90;
  std::string text;
  if (degrees > 0) text = "turned by " + std::to_string(degrees) + " degrees clockwise";
  if (orientation.Mirrors()) text += text.empty() ? "mirrored" : " and mirrored";
  return text;
}

Rigid3 TurnedFromStored(const Orientation& orientation) {
  PLUMBLINE_CHECK(!orientation.Mirrors(), "a rotation of images");
  Eigen::Matrix3d turned_from_stored = Eigen::Matrix3d::Zero();
  const double x = orientation.flip_x ? -1 : 1;
  const double y = orientation.flip_y ? -1 : 1;
  turned_from_stored(0, orientation.transpose ? 1 : 0) = x;
  turned_from_stored(1, orientation.transpose ? 0 : 1) = y;
  turned_from_stored(2, 2) = 1;
  return {Eigen::Quaterniond(turned_from_stored).normalized(), Eigen::Vector3d::Zero()};
}

Camera Turned(const Camera& camera, const Orientation& orientation) {
  CameraIntrinsics in = camera.intrinsics();
  // Tangential distortion: p1 bends along y, p2 along x. All else depends on the radius alone.
  const bool omni = in.model == DistortionModel::kOmni;
  const bool tangential =
      omni || in.model == DistortionModel::kRadTan || in.model == DistortionModel::kRational;
  double& p1 = in.distortion[omni ? 3 : 2];
  double& p2 = in.distortion[omni ? 4 : 3];
  if (orientation.transpose) {
    std::swap(in.width, in.height);
    std::swap(in.fx, in.fy);
    std::swap(in.cx, in.cy);
    if (tangential) std::swap(p1, p2);
  }
  if (orientation.flip_x) {
    in.cx = in.width - 1 - in.cx;
    if (tangential) p2 = -p2;
  }
  if (orientation.flip_y) {
    in.cy = in.height - 1 - in.cy;
    if (tangential) p1 = -p1;
  }
  return Camera(in);
}

Calibration Turned(Calibration calibration, const Orientation& orientation) {
  if (orientation.IsIdentity()) return calibration;
  PLUMBLINE_CHECK(!calibration.right.has_value(), "one camera to turn");
  calibration.left = Turned(calibration.left, orientation);
  if (calibration.body_from_left && !orientation.Mirrors()) {
    calibration.body_from_left =
        *calibration.body_from_left * Inverse(TurnedFromStored(orientation));
  }
  return calibration;
}

namespace {

// Sums of a row over the columns of the target. A pixel of the row is `target` units wide and one
// of the target `source` units, so that a pixel has a part in two sums at most.
void SumColumns(const std::uint8_t* row, std::uint32_t source, std::vector<std::uint32_t>& sums) {
  const auto target = static_cast<std::uint32_t>(sums.size());
  std::uint32_t sum = 0;
  std::uint32_t left = source;  // part of the sum that is still missing
  std::size_t column = 0;
  for (std::uint32_t x = 0; x < source; ++x) {
    const std::uint32_t level = row[x];
    if (left > target) {
      sum += target * level;
      left -= target;
      continue;
    }
    sums[column++] = sum + left * level;
    const std::uint32_t rest = target - left;
    sum = rest * level;
    left = source - rest;
  }
}

}  // namespace

GrayImage AreaAveraged(const GrayImage& image, int width, int height) {
  PLUMBLINE_CHECK(width >= 1 && height >= 1 && width <= image.width() && height <= image.height(),
                  "an image to make smaller");
  const auto source = static_cast<std::uint64_t>(image.height());
  const auto target = static_cast<std::uint64_t>(height);
  const double area = static_cast<double>(image.width()) * image.height();
  GrayImage averaged(width, height);
  std::vector<std::uint32_t> columns(static_cast<std::size_t>(width));
  std::vector<std::uint64_t> sums(columns.size(), 0);
  const auto add = [&](std::uint64_t weight) {
    for (std::size_t x = 0; x < sums.size(); ++x) sums[x] += weight * columns[x];
  };
  std::uint64_t left = source;  // as in SumColumns
  int row = 0;
  for (int y = 0; y < image.height(); ++y) {
    SumColumns(image.row(y), static_cast<std::uint32_t>(image.width()), columns);
    if (left > target) {
      add(target);
      left -= target;
      continue;
    }
    add(left);
    std::uint8_t* const to = averaged.row(row++);
    for (std::size_t x = 0; x < sums.size(); ++x) {
      // The same everywhere: both numbers are whole and less than 2^53.
      to[x] = static_cast<std::uint8_t>(static_cast<double>(sums[x]) / area + 0.5);
    }
    std::fill(sums.begin(), sums.end(), 0);
    add(target - left);
    left = source - (target - left);
  }
  return averaged;
}

DepthImage NearestPixels(const DepthImage& image, int width, int height) {
  PLUMBLINE_CHECK(width >= 1 && height >= 1 && !image.empty(), "an image to resample");
  const auto nearest = [](int i, int target, int source) {
    return static_cast<int>((2 * std::int64_t{i} + 1) * source / (2 * std::int64_t{target}));
  };
  DepthImage chosen(width, height);
  for (int y = 0; y < height; ++y) {
    const float* from = image.row(nearest(y, height, image.height()));
    for (int x = 0; x < width; ++x) chosen.at(x, y) = from[nearest(x, width, image.width())];
  }
  return chosen;
}

}  // namespace plumbline
