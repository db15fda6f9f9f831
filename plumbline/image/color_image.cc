// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/color_image.h"

#include "plumbline/base/error.h"
#include "plumbline/image/opencv_bridge.h"

#include <algorithm>
#include <array>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace plumbline {

ColorImage FromInterleaved(int width, int height, const InterleavedPixels& pixels) {
  const auto row_bytes = static_cast<std::size_t>(width) * static_cast<std::size_t>(pixels.bytes);
  const auto rows = static_cast<std::size_t>(height);
  PLUMBLINE_CHECK(
      width > 0 && height > 0 && pixels.data.size() >= pixels.step * (rows - 1) + row_bytes,
      "as many bytes as there are pixels");
  ColorImage image{GrayImage(width, height), GrayImage(width, height), GrayImage(width, height)};
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* in = pixels.data.data() + pixels.step * static_cast<std::size_t>(y);
    for (int x = 0; x < width; ++x, in += pixels.bytes) {
      image.red.at(x, y) = in[pixels.red];
      image.green.at(x, y) = in[1];
      image.blue.at(x, y) = in[2 - pixels.red];
    }
  }
  return image;
}

GrayImage ToGray(const ColorImage& image) {
  const std::array<cv::Mat, 3> channels = {AsMat(image.blue), AsMat(image.green), AsMat(image.red)};
  cv::Mat merged;
  cv::merge(channels.data(), channels.size(), merged);
  GrayImage gray(image.width(), image.height());
  cv::Mat out = AsMat(gray);
  cv::cvtColor(merged, out, cv::COLOR_BGR2GRAY);
  return gray;
}

bool IsGray(const ColorImage& image) {
  const auto same = [size = static_cast<std::ptrdiff_t>(image.width()) * image.height()](
                        const GrayImage& a, const GrayImage& b) {
    return std::equal(a.data(), a.data() + size, b.data());
  };
  return same(image.red, image.green) && same(image.red, image.blue);
}

}  // namespace plumbline
