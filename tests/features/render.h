// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/random.h"
#include "plumbline/features/types.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/image/image.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

namespace plumbline {

// Samples a grey-level function of the image plane, 4x4 positions per pixel averaged.
inline GrayImage Render(int width,
                        int height,
                        const std::function<double(const Eigen::Vector2d&)>& level) {
  GrayImage image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      for (int k = 0; k < 16; ++k) {
        sum += level({x + (k % 4 - 1.5) / 4, y + (k / 4 - 1.5) / 4});
      }
      image.at(x, y) = static_cast<std::uint8_t>(std::clamp(std::lround(sum / 16), 0L, 255L));
    }
  }
  return image;
}

// Squares of random size and grey level at random places: corners and edges everywhere.
class SquareTexture {
 public:
  SquareTexture(int count, double extent_x, double extent_y) {
    Rng rng(7, "square texture");
    for (int i = 0; i < count; ++i) {
      const double half = rng.Uniform(4, 14);
      squares_.push_back({rng.Uniform(-20, extent_x + 20),
                          rng.Uniform(-20, extent_y + 20),
                          half,
                          rng.Uniform(20, 235)});
    }
  }

  double operator()(const Eigen::Vector2d& p) const {
    double level = 128;
    for (const Square& s : squares_) {
      if (std::abs(p.x() - s.x) < s.half && std::abs(p.y() - s.y) < s.half) level = s.level;
    }
    return level;
  }

 private:
  struct Square {
    double x, y, half, level;
  };
  std::vector<Square> squares_;
};

inline RectifiedCamera TestCamera(int width, int height) {
  return {.fx = 300,
          .fy = 300,
          .cx = 0.5 * width,
          .cy = 0.5 * height,
          .baseline = 0.1,
          .width = width,
          .height = height};
}

}  // namespace plumbline
