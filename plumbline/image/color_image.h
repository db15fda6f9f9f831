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
  // True if the colours are equal.
  friend bool operator==(const Color&, const Color&) = default;
};

// A colour image as three grey images of the same size: operations on grey images (rectifying,
// turning, reducing) apply to each of them (WithEachChannel). All three are equal if the image was
// stored grey.
struct ColorImage {
  GrayImage red, green, blue;

  // Columns.
  int width() const { return red.width(); }
  // Rows.
  int height() const { return red.height(); }
  // Pixel in column x and row y; not checked.
  Color at(int x, int y) const { return {red.at(x, y), green.at(x, y), blue.at(x, y)}; }
};

// Returns the image with `change` applied to each channel.
template <class Change>
ColorImage WithEachChannel(ColorImage image, const Change& change) {
  return {
      change(std::move(image.red)), change(std::move(image.green)), change(std::move(image.blue))};
}

// Returns a grey image as a colour image.
inline ColorImage ToColor(const GrayImage& gray) { return {gray, gray, gray}; }

// Memory layout of interleaved pixels with 8 bits per channel.
struct InterleavedPixels {
  std::span<const std::uint8_t> data;
  std::size_t step = 0;  // bytes from a row to the next one
  int bytes = 3;         // of a pixel
  int red = 2;           // index of red; blue is 2 - red, green 1
};

// Returns the colour image of interleaved pixels; throws BugError if `data` is too short.
ColorImage FromInterleaved(int width, int height, const InterleavedPixels& pixels);

// Returns 0.299 R + 0.587 G + 0.114 B, rounded as ReadGrayImage (io/image_file.h) does.
GrayImage ToGray(const ColorImage& image);

// Returns true if red, green and blue are equal everywhere.
bool IsGray(const ColorImage& image);

}  // namespace plumbline
