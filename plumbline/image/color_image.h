// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace plumbline {

// A colour, 0 to 255 each.
struct Color {
  std::uint8_t r = 0, g = 0, b = 0;
  // Whether two colours are the same.
  friend bool operator==(const Color&, const Color&) = default;
};

// An image in colour, as three grey images of the same size: what is done to a grey image
// (rectifying, turning, reducing) is done to each of them (WithEachChannel). All three are the same
// where the image was stored grey.
struct ColorImage {
  GrayImage red, green, blue;

  // Columns.
  int width() const { return red.width(); }
  // Rows.
  int height() const { return red.height(); }
  // The pixel in column x of row y, which are not checked.
  Color at(int x, int y) const { return {red.at(x, y), green.at(x, y), blue.at(x, y)}; }
};

// Returns an image of which each channel is `change` of that of another one.
template <class Change>
ColorImage WithEachChannel(ColorImage image, const Change& change) {
  return {
      change(std::move(image.red)), change(std::move(image.green)), change(std::move(image.blue))};
}

// Returns a grey image as one in colour.
inline ColorImage ToColor(const GrayImage& gray) { return {gray, gray, gray}; }

// How pixels of 8 bits a channel lie side by side in memory.
struct InterleavedPixels {
  std::span<const std::uint8_t> data;
  std::size_t step = 0;  // bytes from a row to the next one
  int bytes = 3;         // of a pixel
  int red = 2;           // which of them is red; blue is 2 - red, green 1
};

// Returns the colours of pixels; `data` must hold them (BugError).
ColorImage FromInterleaved(int width, int height, const InterleavedPixels& pixels);

// Returns 0.299 R + 0.587 G + 0.114 B, rounded as ReadGrayImage (io/image_file.h) does.
GrayImage ToGray(const ColorImage& image);

// Whether red, green and blue are the same everywhere.
bool IsGray(const ColorImage& image);

}  // namespace plumbline
