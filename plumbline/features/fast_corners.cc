// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/fast_corners.h"

#include "plumbline/base/error.h"
#include "plumbline/base/processor.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace plumbline {
namespace {

using Byte = std::uint8_t;
constexpr std::size_t kCircle = 16;

[[gnu::always_inline]] inline Byte Min(Byte a, Byte b) { return a < b ? a : b; }
[[gnu::always_inline]] inline Byte Max(Byte a, Byte b) { return a > b ? a : b; }
// Returns max(a - b, 0).
[[gnu::always_inline]] inline Byte Excess(Byte a, Byte b) {
  return static_cast<Byte>(Max(a, b) - b);
}

// Returns the largest of the minima of nine neighbours on the circle.
[[gnu::always_inline]] inline Byte BestOfNine(const Byte* v) {
  Byte two[kCircle / 2], four[kCircle / 2];  // minima of two and of four neighbours from 2 k + 1 on
  for (std::size_t k = 0; k < kCircle / 2; ++k) {
    two[k] = Min(v[2 * k + 1], v[(2 * k + 2) % kCircle]);
  }
  for (std::size_t k = 0; k < kCircle / 2; ++k) {
    four[k] = Min(two[k], two[(k + 1) % (kCircle / 2)]);
  }
  Byte best = 0;
  for (std::size_t k = 0; k < kCircle / 2; ++k) {
    const Byte eight = Min(four[k], four[(k + 2) % (kCircle / 2)]);
    best = Max(best, Min(eight, Max(v[2 * k], v[(2 * k + 9) % kCircle])));
  }
  return best;
}

// Computes the contrast of the pixels of a row. The loop becomes vector code.
struct ContrastOfRow {
  [[gnu::always_inline]] static inline void Run(const Byte* row,
                                                std::ptrdiff_t width,
                                                int count,
                                                Byte* contrast) {
    const Byte* const circle[kCircle] = {row + 3 * width,
                                         row + 3 * width + 1,
                                         row + 2 * width + 2,
                                         row + width + 3,
                                         row + 3,
                                         row - width + 3,
                                         row - 2 * width + 2,
                                         row - 3 * width + 1,
                                         row - 3 * width,
                                         row - 3 * width - 1,
                                         row - 2 * width - 2,
                                         row - width - 3,
                                         row - 3,
                                         row + width - 3,
                                         row + 2 * width - 2,
                                         row + 3 * width - 1};
    ForBlocks<32>(
        count, [&](int first, auto size) __attribute__((always_inline)) {
          // a local array, which cannot overlap others, so that no check is needed
          Byte block[size];
          for (int i = 0; i < size; ++i) {
            Byte brighter[kCircle], darker[kCircle];
            const Byte centre = row[first + i];
            for (std::size_t k = 0; k < kCircle; ++k) {
              brighter[k] = Excess(circle[k][first + i], centre);
              darker[k] = Excess(centre, circle[k][first + i]);
            }
            block[i] = Max(BestOfNine(brighter), BestOfNine(darker));
          }
          std::memcpy(contrast + first, block, size);
        });
  }
};

// Marks pixels of a row with 1 that are above the threshold and above the eight pixels around them.
struct MaximaOfRow {
  [[gnu::always_inline]] static inline void Run(const Byte* above,
                                                const Byte* row,
                                                const Byte* below,
                                                int count,
                                                Byte threshold,
                                                Byte* maxima) {
    ForBlocks<32>(
        count, [&](int first, auto size) __attribute__((always_inline)) {
          Byte block[size];
          for (int i = 0; i < size; ++i) {
            const int x = first + i;
            const Byte upper = Max(Max(above[x - 1], above[x]), above[x + 1]);
            const Byte lower = Max(Max(below[x - 1], below[x]), below[x + 1]);
            const Byte beside = Max(row[x - 1], row[x + 1]);
            const Byte most = Max(Max(upper, lower), Max(beside, threshold));
            block[i] = row[x] > most ? 1 : 0;
          }
          std::memcpy(maxima + first, block, size);
        });
  }
};

}  // namespace

FastCorners::FastCorners(const GrayImage& image, const PixelBox& area) : area_(area) {
  if (area.empty()) return;
  PLUMBLINE_CHECK(area.x0 >= kReach && area.y0 >= kReach && area.x1 + kReach <= image.width() &&
                      area.y1 + kReach <= image.height(),
                  "corners away from the border");
  const int width = area.x1 - area.x0;
  const int height = area.y1 - area.y0;
  contrast_ = GrayImage(width + 2, height + 2);
  for (int y = 0; y < height; ++y) {
    RunBest<ContrastOfRow>(
        image.row(area.y0 + y) + area.x0, image.width(), width, contrast_.row(y + 1) + 1);
  }
}

void FastCorners::Collect(const PixelBox& part,
                          int threshold,
                          std::vector<FastCorner>* corners) const {
  const int width = std::min(part.x1, area_.x1) - part.x0;
  const int last = std::min(part.y1, area_.y1) - 1;
  if (width <= 0 || part.y0 > last) return;
  PLUMBLINE_CHECK(part.x0 >= area_.x0 && part.y0 >= area_.y0, "a part of the area");
  // Three rows of the part, without the pixels beside it.
  const auto size = static_cast<std::size_t>(width);
  std::array<std::vector<Byte>, 3> rows;
  for (std::vector<Byte>& row : rows) row.assign(size + 2, 0);
  const auto fill = [&](int y) {
    std::vector<Byte>& row = rows[static_cast<std::size_t>(y - part.y0) % 3];
    if (y > last) {
      std::fill(row.begin(), row.end(), Byte{0});
    } else {
      std::copy_n(contrast_.row(y - area_.y0 + 1) + part.x0 - area_.x0 + 1, size, row.data() + 1);
    }
  };
  std::vector<Byte> maxima(size + 8, 0);
  fill(part.y0);
  for (int y = part.y0; y <= last; ++y) {
    fill(y + 1);
    const auto at = static_cast<std::size_t>(y - part.y0);
    const Byte* row = rows[at % 3].data() + 1;
    RunBest<MaximaOfRow>(rows[(at + 2) % 3].data() + 1,
                         row,
                         rows[(at + 1) % 3].data() + 1,
                         width,
                         static_cast<Byte>(std::min(threshold, 255)),
                         maxima.data());
    for (std::size_t x = 0; x < size; x += 8) {
      std::uint64_t eight = 0;
      std::memcpy(&eight, maxima.data() + x, sizeof eight);
      if (eight == 0) continue;
      for (std::size_t i = x; i < std::min(x + 8, size); ++i) {
        if (maxima[i] == 0) continue;
        corners->push_back({part.x0 + static_cast<int>(i), y, static_cast<float>(row[i] - 1)});
      }
    }
  }
}

}  // namespace plumbline
