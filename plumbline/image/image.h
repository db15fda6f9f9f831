// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace plumbline {

// An image of one channel, rows top to bottom without padding. A value type: a copy copies the
// pixels.
template <class T>
class Image {
 public:
  Image() = default;
  // An image of this size with every pixel equal to `fill`.
  Image(int width, int height, T fill = T{})
      : width_(width),
        height_(height),
        pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), fill) {}

  // Columns.
  int width() const { return width_; }
  // Rows.
  int height() const { return height_; }
  // Returns true if it has no pixels.
  bool empty() const { return pixels_.empty(); }
  // The pixels, width() * height() of them.
  T* data() { return pixels_.data(); }
  // The pixels, width() * height() of them.
  const T* data() const { return pixels_.data(); }
  // Pixels of row y; not checked.
  T* row(int y) { return pixels_.data() + static_cast<std::ptrdiff_t>(y) * width_; }
  // Pixels of row y; not checked.
  const T* row(int y) const { return pixels_.data() + static_cast<std::ptrdiff_t>(y) * width_; }
  // Pixel in column x and row y; not checked.
  T& at(int x, int y) { return row(y)[x]; }
  // Pixel in column x and row y; not checked.
  const T& at(int x, int y) const { return row(y)[x]; }

 private:
  int width_ = 0;
  int height_ = 0;
  std::vector<T> pixels_;
};

// Grey levels, 0 black to 255 white.
using GrayImage = Image<std::uint8_t>;
// Metres along z; 0 if not measured.
using DepthImage = Image<float>;

// Images and depth of one instant, as decoded, before rectification.
struct SensorFrame {
  std::int64_t stamp_ns = 0;
  GrayImage left;
  std::optional<GrayImage> right;   // stereo
  std::optional<DepthImage> depth;  // RGB-D, registered to `left`
  // Masks, of the size of the images: pixels of 0 (black) are not used, all others (white) are.
  // Null: all pixels are used. Frames may share a mask.
  std::shared_ptr<const GrayImage> left_mask = nullptr, right_mask = nullptr;
};

}  // namespace plumbline
