// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"

#include <cstdint>

namespace plumbline {

// A grey 8 bit image sensor behind a lens.
struct SensorModel {
  double gain = 1;           // brightness; at 1, white in the world is white in the image
  double gamma = 1;          // of the response curve, 1 linear
  double vignetting = 0.22;  // loss of light in the corners, by the square of the distance
  double noise = 1;          // 1 as a real camera, 0 none
  double blur_px = 0.5;      // of the lens: standard deviation of the image of a point
};

// Returns the sensor's image of light (255 is white at gain 1): lens blur, electrons with shot
// noise, pixels of slightly unequal gain, read noise; then the response curve, which bends off over
// the brightest eighth instead of clipping, and rounding to 8 bits. Values of pixels are functions
// of `stream`, different for each image, and `chip`, constant for a sensor.
GrayImage Expose(const Image<float>& scene,
                 const SensorModel& model,
                 std::uint64_t chip,
                 std::uint64_t stream);

// Depth of a structured-light sensor: noise that grows with the square of the distance (1.4 mm at 1
// m), in steps of disparity, nothing beyond 9 m; `noise` multiplies everything but the range.
DepthImage SenseDepth(const DepthImage& depth, double noise, std::uint64_t stream);

}  // namespace plumbline
