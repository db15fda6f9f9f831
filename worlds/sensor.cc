// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/sensor.h"

#include "plumbline/base/elementary.h"
#include "worlds/noise.h"

#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

constexpr float kFullWell = 12'000;    // electrons at white
constexpr float kReadNoise = 40;       // electrons
constexpr float kGainSpread = 0.006F;  // of pixels, relative
constexpr std::uint64_t kGainChannel = 0x6A1F;

// Linear up to the knee, then bending towards 1 without reaching it.
float Shoulder(float value) {
  constexpr float kKnee = 0.875F, kRoom = 1 - kKnee;
  if (value <= kKnee) return value;
  return kKnee + kRoom * (1 - static_cast<float>(math::Exp(-(value - kKnee) / kRoom)));
}

// Three weights of a filter with the variance of a Gaussian.
struct Spread {
  float side, centre;

  explicit Spread(double sigma)
      : side(static_cast<float>(0.5 * std::min(sigma * sigma, 1.0))), centre(1 - 2 * side) {}
};

// The image of a lens that is not perfectly sharp; the border is continued.
Image<float> ThroughLens(const Image<float>& light, double blur_px) {
  const Spread spread(blur_px);
  const int width = light.width(), height = light.height();
  Image<float> rows(width, height), result(width, height);
  for (int y = 0; y < height; ++y) {
    const float* from = light.row(y);
    for (int x = 0; x < width; ++x) {
      rows.at(x, y) = spread.centre * from[x] +
                      spread.side * (from[std::max(x - 1, 0)] + from[std::min(x + 1, width - 1)]);
    }
  }
  for (int y = 0; y < height; ++y) {
    const float *above = rows.row(std::max(y - 1, 0)), *here = rows.row(y);
    const float* below = rows.row(std::min(y + 1, height - 1));
    for (int x = 0; x < width; ++x) {
      result.at(x, y) = spread.centre * here[x] + spread.side * (above[x] + below[x]);
    }
  }
  return result;
}

}  // namespace

GrayImage Expose(const Image<float>& scene,
                 const SensorModel& model,
                 std::uint64_t chip,
                 std::uint64_t stream) {
  const Image<float> light = ThroughLens(scene, model.blur_px);
  const int width = light.width(), height = light.height();
  const auto noise = static_cast<float>(model.noise);
  const auto gain = static_cast<float>(model.gain) / 255;
  const auto vignetting = static_cast<float>(model.vignetting);
  const auto inverse_gamma = static_cast<float>(1 / model.gamma);
  const float centre_x = 0.5F * static_cast<float>(width - 1);
  const float centre_y = 0.5F * static_cast<float>(height - 1);
  const float corner = centre_x * centre_x + centre_y * centre_y;
  GrayImage image(width, height);
  for (int y = 0; y < height; ++y) {
    const float dy = static_cast<float>(y) - centre_y;
    for (int x = 0; x < width; ++x) {
      const float dx = static_cast<float>(x) - centre_x;
      const float fall_off = 1 - vignetting * (dx * dx + dy * dy) / corner;
      float electrons = kFullWell * gain * fall_off * light.at(x, y);
      if (noise > 0) {
        const float spread =
            1 + noise * kGainSpread * NormalFromHash(HashCell(x, y, chip + kGainChannel));
        const float sigma = noise * std::sqrt(kReadNoise * kReadNoise + electrons);
        electrons = spread * electrons + sigma * NormalFromHash(HashCell(x, y, stream));
      }
      float value = Shoulder(std::max(0.0F, electrons / kFullWell));
      if (model.gamma != 1) value = static_cast<float>(math::Pow(value, inverse_gamma));
      image.at(x, y) = static_cast<std::uint8_t>(255 * std::min(value, 1.0F) + 0.5F);
    }
  }
  return image;
}

DepthImage SenseDepth(const DepthImage& depth, double noise, std::uint64_t stream) {
  constexpr float kFarthest = 9, kNearest = 0.4F, kSigma = 0.0014F;  // at 1 m
  constexpr float kStep = 0.0028F;  // of 1 / depth times depth squared, at 1 m
  const auto factor = static_cast<float>(noise);
  DepthImage sensed(depth.width(), depth.height());
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      const float z = depth.at(x, y);
      if (z < kNearest || z > kFarthest) continue;
      float inverse = 1 / z;
      if (factor > 0) {
        inverse += factor * kSigma * NormalFromHash(HashCell(x, y, stream));
        const float step = factor * kStep;
        inverse = step * std::round(inverse / step);
      }
      if (inverse > 0) sensed.at(x, y) = 1 / inverse;
    }
  }
  return sensed;
}

}  // namespace plumbline
