// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"
#include "plumbline/base/random.h"
#include "plumbline/geometry/calibration.h"
#include "plumbline/image/image.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace plumbline {

// A stereo camera that moves sideways before a poster: images by shifting one picture. From frame
// to frame the picture moves by kStepPx; the right image lies kDisparityPx further.
class MovingPoster {
 public:
  static constexpr int kWidth = 400;
  static constexpr int kHeight = 300;
  static constexpr int kStepPx = 3;
  static constexpr int kDisparityPx = 12;
  static constexpr double kFocal = 300;
  static constexpr double kBaseline = 0.12;
  static constexpr double kDepth = kFocal * kBaseline / kDisparityPx;  // 3 m
  static constexpr double kStep = kStepPx * kDepth / kFocal;           // 3 cm

  MovingPoster() : picture_(kWidth + 400, kHeight, 128) {
    Rng rng(12, "moving_poster");
    for (int i = 0; i < 900; ++i) {
      const auto x = static_cast<int>(rng.Index(kWidth + 400));
      const auto y = static_cast<int>(rng.Index(kHeight));
      const auto w = static_cast<int>(4 + rng.Index(36));
      const auto h = static_cast<int>(4 + rng.Index(36));
      FillIn(picture_, x, y, w, h, static_cast<std::uint8_t>(rng.Index(256)));
    }
  }

  // Both cameras rotated about the vertical against the baseline by `yaw`: the rectified camera
  // then differs from the delivered one. (The images are those of yaw 0; small angles do no harm.)
  static Calibration MakeCalibration(double yaw = 0) {
    Calibration calibration;
    calibration.left = Camera({.fx = kFocal,
                               .fy = kFocal,
                               .cx = kWidth / 2.0,
                               .cy = kHeight / 2.0,
                               .width = kWidth,
                               .height = kHeight});
    calibration.right = calibration.left;
    calibration.right_from_left.translation =
        -kBaseline * Eigen::Vector3d(std::cos(yaw), 0, std::sin(yaw));
    calibration.rectified = yaw == 0;
    calibration.rate_hz = 20;
    return calibration;
  }

  SensorFrame Frame(int index) const {
    SensorFrame frame;
    frame.stamp_ns = StampNs(index);
    frame.left = Cut(kStepPx * index);
    frame.right = Cut(kStepPx * index + kDisparityPx);
    return frame;
  }
  // A frame of one grey level, without features.
  static SensorFrame BlindFrame(int index) {
    return {StampNs(index), GrayImage(kWidth, kHeight, 90), GrayImage(kWidth, kHeight, 90), {}};
  }
  // A frame of another place, with enough features for a pose, and too few to start a map.
  static SensorFrame StrangeFrame(int index) {
    SensorFrame frame = BlindFrame(index);
    FillIn(frame.left, 200, 120, 25, 25, 200);
    FillIn(*frame.right, 200 - kDisparityPx, 120, 25, 25, 200);
    return frame;
  }
  // A frame of a covered lens: different noise in each image.
  static SensorFrame NoiseFrame(int index) {
    SensorFrame frame = BlindFrame(index);
    Rng rng(12, "covered_lens", static_cast<std::uint64_t>(index));
    for (GrayImage* image : {&frame.left, &*frame.right}) {
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
          image->row(y)[x] = static_cast<std::uint8_t>(rng.Index(40));
        }
      }
    }
    return frame;
  }
  static std::int64_t StampNs(int index) { return 1'000'000'000 + 50'000'000LL * index; }

 private:
  static void FillIn(GrayImage& image, int x0, int y0, int w, int h, std::uint8_t value) {
    for (int y = y0; y < std::min(y0 + h, image.height()); ++y) {
      std::fill(image.row(y) + x0, image.row(y) + std::min(x0 + w, image.width()), value);
    }
  }
  GrayImage Cut(int x0) const {
    if (x0 < 0 || x0 + kWidth > picture_.width()) throw BugError("the camera has left the poster");
    GrayImage image(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y) {
      std::copy_n(picture_.row(y) + x0, kWidth, image.row(y));
    }
    return image;
  }

  GrayImage picture_;
};

}  // namespace plumbline
