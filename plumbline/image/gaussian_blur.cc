// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/gaussian_blur.h"

#include "plumbline/base/processor.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <vector>

namespace plumbline {
namespace {

constexpr int kReach = 3;
constexpr int kTaps = 2 * kReach + 1;
constexpr int kBlock = 32;

// Blurs a row of pixels, in 256ths. `padded` begins kReach before its first pixel.
struct BlurAlong {
  [[gnu::always_inline]] static inline void Run(const std::uint8_t* padded,
                                                const BlurWeights& weights,
                                                int width,
                                                std::uint16_t* blurred) {
    // Clang 14 does not let a lambda capture the names of a structured binding.
    const auto w0 = weights[0], w1 = weights[1], w2 = weights[2], w3 = weights[3];
    ForBlocks<kBlock>(
        width, [&](int first, auto size) __attribute__((always_inline)) {
          std::uint16_t block[size];
          const std::uint8_t* p = padded + first;
          for (int i = 0; i < size; ++i) {
            const auto far = static_cast<std::uint16_t>(p[i] + p[i + 6]);
            const auto middle = static_cast<std::uint16_t>(p[i + 1] + p[i + 5]);
            const auto near = static_cast<std::uint16_t>(p[i + 2] + p[i + 4]);
            block[i] =
                static_cast<std::uint16_t>(w0 * far + w1 * middle + w2 * near + w3 * p[i + 3]);
          }
          std::memcpy(blurred + first, block, sizeof block);
        });
  }
};

using Rows = std::array<const std::uint16_t*, kTaps>;

struct BlurAcross {
  [[gnu::always_inline]] static inline void Run(const Rows& rows,
                                                const BlurWeights& weights,
                                                int width,
                                                std::uint8_t* blurred) {
    const auto r0 = rows[0], r1 = rows[1], r2 = rows[2], r3 = rows[3], r4 = rows[4], r5 = rows[5],
               r6 = rows[6];
    const std::uint32_t w0 = weights[0], w1 = weights[1], w2 = weights[2], w3 = weights[3];
    constexpr std::uint32_t kHalf = 1U << 15;
    ForBlocks<kBlock>(
        width, [&](int first, auto size) __attribute__((always_inline)) {
          std::uint8_t block[size];
          for (int i = 0; i < size; ++i) {
            const int x = first + i;
            const std::uint32_t far = std::uint32_t{r0[x]} + r6[x];
            const std::uint32_t middle = std::uint32_t{r1[x]} + r5[x];
            const std::uint32_t near = std::uint32_t{r2[x]} + r4[x];
            const std::uint32_t sum = w0 * far + w1 * middle + w2 * near + w3 * r3[x];
            block[i] = static_cast<std::uint8_t>((sum + kHalf) >> 16);
          }
          std::memcpy(blurred + first, block, size);
        });
  }
};

// Returns the pixel that stands for one beyond the border of a row or column of this size.
int Inside(int place, int size, ImageBorder border) {
  if (border == ImageBorder::kRepeated || size == 1) return std::clamp(place, 0, size - 1);
  while (place < 0 || place >= size) place = place < 0 ? -place : 2 * (size - 1) - place;
  return place;
}

}  // namespace

GrayImage Blurred(const GrayImage& image, const BlurWeights& weights, ImageBorder border) {
  const int width = image.width();
  const int height = image.height();
  GrayImage result(width, height);
  if (image.empty()) return result;
  const auto columns = static_cast<std::size_t>(width);
  std::vector<std::uint8_t> padded(columns + 2 * kReach);
  // The last rows that were blurred along the row, with row y at y modulo kKept.
  constexpr int kKept = kTaps + 1;
  std::array<std::vector<std::uint16_t>, kKept> kept;
  for (auto& row : kept) row.resize(columns);
  const auto kept_row = [&](int y) -> std::vector<std::uint16_t>& {
    return kept[static_cast<std::size_t>(y % kKept)];
  };
  int next = 0;
  for (int y = 0; y < height; ++y) {
    for (; next <= std::min(y + kReach, height - 1); ++next) {
      const std::uint8_t* row = image.row(next);
      std::copy_n(row, columns, padded.data() + kReach);
      for (int i = 1; i <= kReach; ++i) {
        padded[static_cast<std::size_t>(kReach - i)] = row[Inside(-i, width, border)];
        padded[columns + static_cast<std::size_t>(kReach + i - 1)] =
            row[Inside(width - 1 + i, width, border)];
      }
      RunBest<BlurAlong>(padded.data(), weights, width, kept_row(next).data());
    }
    Rows rows;
    for (int k = 0; k < kTaps; ++k) {
      rows[static_cast<std::size_t>(k)] = kept_row(Inside(y + k - kReach, height, border)).data();
    }
    RunBest<BlurAcross>(rows, weights, width, result.row(y));
  }
  return result;
}

}  // namespace plumbline
