// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/gradient.h"

#include "plumbline/base/processor.h"
#include "plumbline/image/gaussian_blur.h"
#include "plumbline/image/opencv_bridge.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace plumbline {

namespace {

// Three rows of pixels, weighted by 1, 2, 1 and by -1, 0, 1, with one more column at either end.
struct RowPair {
  std::vector<std::int16_t> smooth;
  std::vector<std::int16_t> change;
};

// Applies the Sobel operator to one row, whose border is repeated.
struct SobelOfRow {
  [[gnu::always_inline]] static inline void Run(const std::uint8_t* above,
                                                const std::uint8_t* row,
                                                const std::uint8_t* below,
                                                int width,
                                                RowPair* rows,
                                                std::int16_t* dx,
                                                std::int16_t* dy) {
    std::int16_t* smooth = rows->smooth.data() + 1;
    std::int16_t* change = rows->change.data() + 1;
    ForBlocks<32>(
        width, [&](int first, auto size) __attribute__((always_inline)) {
          std::int16_t smooth_block[size], change_block[size];
          for (int i = 0; i < size; ++i) {
            const int x = first + i;
            smooth_block[i] = static_cast<std::int16_t>(above[x] + 2 * row[x] + below[x]);
            change_block[i] = static_cast<std::int16_t>(below[x] - above[x]);
          }
          std::memcpy(smooth + first, smooth_block, sizeof smooth_block);
          std::memcpy(change + first, change_block, sizeof change_block);
        });
    for (std::int16_t* r : {smooth, change}) {
      r[-1] = r[0];
      r[width] = r[width - 1];
    }
    ForBlocks<32>(
        width, [&](int first, auto size) __attribute__((always_inline)) {
          std::int16_t dx_block[size], dy_block[size];
          for (int i = 0; i < size; ++i) {
            const int x = first + i;
            dx_block[i] = static_cast<std::int16_t>(smooth[x + 1] - smooth[x - 1]);
            dy_block[i] = static_cast<std::int16_t>(change[x - 1] + 2 * change[x] + change[x + 1]);
          }
          std::memcpy(dx + first, dx_block, sizeof dx_block);
          std::memcpy(dy + first, dy_block, sizeof dy_block);
        });
  }
};

GrayImage Smoothed(const GrayImage& image, double sigma) {
  if (sigma == 1) return Blurred(image, kBlurSigma1, ImageBorder::kRepeated);
  GrayImage blurred(image.width(), image.height());
  cv::Mat target = AsMat(blurred);
  const int size = 2 * static_cast<int>(std::ceil(2.5 * sigma)) + 1;
  cv::GaussianBlur(AsMat(image), target, {size, size}, sigma, sigma, cv::BORDER_REPLICATE);
  return blurred;
}

}  // namespace

GradientImage ComputeGradient(const GrayImage& image, double sigma) {
  PLUMBLINE_CHECK(!image.empty(), "gradient of an empty image");
  GradientImage gradient{Image<std::int16_t>(image.width(), image.height()),
                         Image<std::int16_t>(image.width(), image.height())};
  const GrayImage blurred = sigma > 0 ? Smoothed(image, sigma) : GrayImage();
  const GrayImage& smooth = sigma > 0 ? blurred : image;
  const auto with_ends = static_cast<std::size_t>(image.width() + 2);
  RowPair rows{std::vector<std::int16_t>(with_ends), std::vector<std::int16_t>(with_ends)};
  for (int y = 0; y < image.height(); ++y) {
    RunBest<SobelOfRow>(smooth.row(std::max(y - 1, 0)),
                        smooth.row(y),
                        smooth.row(std::min(y + 1, image.height() - 1)),
                        image.width(),
                        &rows,
                        gradient.dx.row(y),
                        gradient.dy.row(y));
  }
  return gradient;
}

}  // namespace plumbline
