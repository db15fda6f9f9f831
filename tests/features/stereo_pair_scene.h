// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/random.h"
#include "plumbline/geometry/calibration.h"
#include "plumbline/image/image.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace plumbline {

// Stereo pairs of a wall of squares whose parts are at different depths, by an ideal pair of
// cameras that moves to the right, and up and down.
class StereoPairScene {
 public:
  static constexpr int kWidth = 480;
  static constexpr int kHeight = 320;

  // `disparities`: of bands of rows of equal height, from the top down; whole pixels. `motion`:
  // factor on how far the camera moves.
  explicit StereoPairScene(std::vector<int> disparities = {4, 8, 12, 16, 24}, double motion = 1)
      : disparities_(std::move(disparities)), motion_(motion), wall_(1100, 700, 128) {
    Rng rng(3, "stereo pair scene");
    for (int i = 0; i < 4000; ++i) {
      const int x0 = static_cast<int>(rng.Uniform(0, wall_.width()));
      const int y0 = static_cast<int>(rng.Uniform(0, wall_.height()));
      const int side = static_cast<int>(rng.Uniform(6, 24));
      const auto level = static_cast<std::uint8_t>(rng.Uniform(20, 235));
      for (int y = y0; y < std::min(y0 + side, wall_.height()); ++y) {
        for (int x = x0; x < std::min(x0 + side, wall_.width()); ++x) wall_.at(x, y) = level;
      }
    }
  }

  // Of the frame that is number `position`.
  GrayImage Left(std::size_t position) const { return View(position, false); }
  GrayImage Right(std::size_t position) const { return View(position, true); }
  SensorFrame Frame(std::size_t position) const {
    SensorFrame frame;
    frame.stamp_ns = static_cast<std::int64_t>(position) * 50'000'000;
    frame.left = Left(position);
    frame.right = Right(position);
    return frame;
  }

  static Calibration Cameras() {
    Calibration calibration;
    calibration.left = Camera(
        {.fx = 400, .fy = 400, .cx = 239.5, .cy = 159.5, .width = kWidth, .height = kHeight});
    calibration.right = calibration.left;
    calibration.right_from_left.translation = {-0.1, 0, 0};
    return calibration;
  }

 private:
  GrayImage View(std::size_t position, bool right) const {
    const auto t = static_cast<double>(position);
    const int x0 = 60 + static_cast<int>(std::lround(4 * motion_ * t));
    const int y0 = 190 + static_cast<int>(std::lround(60 * motion_ * std::sin(0.8 * t)));
    Rng noise(static_cast<std::uint64_t>(2 * position + (right ? 1 : 0)), "noise of the camera");
    GrayImage image(kWidth, kHeight);
    const int band = kHeight / static_cast<int>(disparities_.size());
    for (int y = 0; y < kHeight; ++y) {
      const auto k = std::min(static_cast<std::size_t>(y / band), disparities_.size() - 1);
      const int shift = right ? disparities_[k] : 0;
      for (int x = 0; x < kWidth; ++x) {
        const double level = wall_.at(x0 + x + shift, y0 + y) + noise.Uniform(-4, 4);
        image.at(x, y) = static_cast<std::uint8_t>(level);
      }
    }
    return image;
  }

  std::vector<int> disparities_;
  double motion_;
  GrayImage wall_;
};

}  // namespace plumbline
