// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/bilinear_map.h"

#include "plumbline/base/error.h"
#include "plumbline/base/processor.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace plumbline {
namespace {

constexpr int kUnit = 32;  // parts of a pixel

struct Place {
  int first;
  int next_weight;  // weight in parts of kUnit
};

// Returns the pixel at or before a place, and the weight of the next pixel. Both pixels are in the
// image, whatever the place.
Place PlaceOf(float place, int size) {
  constexpr float kLimit = 131072;  // more than any side; its parts are exact in single precision
  // Rounds to the nearest number, ties to even.
  const auto units = static_cast<int>(std::nearbyint(std::clamp(place, -kLimit, kLimit) * kUnit));
  const int first = units >> 5;
  if (first < 0) return {0, 0};
  if (first >= size - 1) return {size - 2, kUnit};
  return {first, units & (kUnit - 1)};
}

// There is always a next pixel: a single row or column is its own neighbour.
int AtLeastTwo(int size) { return std::max(size, 2); }

GrayImage Doubled(const GrayImage& image) {
  GrayImage result(AtLeastTwo(image.width()), AtLeastTwo(image.height()));
  for (int y = 0; y < result.height(); ++y) {
    for (int x = 0; x < result.width(); ++x) {
      result.at(x, y) = image.at(std::min(x, image.width() - 1), std::min(y, image.height() - 1));
    }
  }
  return result;
}

struct Interpolate {
  [[gnu::always_inline]] static inline void Run(const std::uint8_t* from,
                                                std::ptrdiff_t from_width,
                                                const std::int32_t* firsts,
                                                const std::uint8_t* right,
                                                const std::uint8_t* below,
                                                int count,
                                                std::uint8_t* out) {
    ForBlocks<32>(
        count, [&](int begin, auto size) __attribute__((always_inline)) {
          std::uint16_t upper[size], lower[size];  // two pixels each, the left one in the low byte
          for (int i = 0; i < size; ++i) {
            const std::uint8_t* first = from + firsts[begin + i];
            std::memcpy(&upper[i], first, 2);
            std::memcpy(&lower[i], first + from_width, 2);
          }
          std::uint8_t block[size];
          for (int i = 0; i < size; ++i) {
            const std::uint16_t x = right[begin + i];
            const std::uint16_t y = below[begin + i];
            const auto left = static_cast<std::uint16_t>(kUnit - x);
            const auto above = static_cast<std::uint32_t>(kUnit - y);
            const auto a =
                static_cast<std::uint16_t>((upper[i] & 255) * left + (upper[i] >> 8) * x);
            const auto b =
                static_cast<std::uint16_t>((lower[i] & 255) * left + (lower[i] >> 8) * x);
            constexpr std::uint32_t kHalf = kUnit * kUnit / 2;
            block[i] = static_cast<std::uint8_t>((a * above + b * y + kHalf) / (kUnit * kUnit));
          }
          std::memcpy(out + begin, block, size);
        });
  }
};

}  // namespace

BilinearMap::BilinearMap(const Image<float>& x, const Image<float>& y, int width, int height)
    : from_width_(width), from_height_(height), width_(x.width()), height_(x.height()) {
  static_assert(std::endian::native == std::endian::little, "pairs of pixels are read at once");
  PLUMBLINE_CHECK(width >= 1 && height >= 1, "an image to interpolate in");
  PLUMBLINE_CHECK(x.width() == y.width() && x.height() == y.height(), "a place for each pixel");
  const auto count = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  first_.reserve(count);
  right_.reserve(count);
  below_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Place column = PlaceOf(x.data()[i], AtLeastTwo(width));
    const Place row = PlaceOf(y.data()[i], AtLeastTwo(height));
    first_.push_back(row.first * AtLeastTwo(width) + column.first);
    right_.push_back(static_cast<std::uint8_t>(column.next_weight));
    below_.push_back(static_cast<std::uint8_t>(row.next_weight));
  }
}

GrayImage BilinearMap::Apply(const GrayImage& from) const {
  PLUMBLINE_CHECK(from.width() == from_width_ && from.height() == from_height_,
                  "an image of the map's size");
  if (std::min(from_width_, from_height_) < 2) {
    BilinearMap doubled = *this;
    doubled.from_width_ = AtLeastTwo(from_width_);
    doubled.from_height_ = AtLeastTwo(from_height_);
    return doubled.Apply(Doubled(from));
  }
  GrayImage result(width_, height_);
  for (int y = 0; y < height_; ++y) {
    const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(y) * width_;
    RunBest<Interpolate>(from.data(),
                         from.width(),
                         first_.data() + row,
                         right_.data() + row,
                         below_.data() + row,
                         width_,
                         result.row(y));
  }
  return result;
}

}  // namespace plumbline
