// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/orientation.h"
#include "plumbline/image/image.h"

#include <cstddef>

namespace plumbline {

// Returns an image turned (geometry/orientation.h).
template <class T>
Image<T> Turned(const Image<T>& image, const Orientation& orientation) {
  const bool transpose = orientation.transpose;
  Image<T> turned(transpose ? image.height() : image.width(),
                  transpose ? image.width() : image.height());
  const std::ptrdiff_t step_x = transpose ? image.width() : 1;
  const std::ptrdiff_t step_y = transpose ? 1 : image.width();
  for (int y = 0; y < turned.height(); ++y) {
    const int from_y = orientation.flip_y ? turned.height() - 1 - y : y;
    const T* from = image.data() + from_y * step_y;
    T* to = turned.row(y);
    for (int x = 0; x < turned.width(); ++x) {
      to[x] = from[step_x * (orientation.flip_x ? turned.width() - 1 - x : x)];
    }
  }
  return turned;
}

// Returns an image reduced to another size, at most that of `image`, by area averaging: each pixel
// is the mean over its area in `image`, rounded to the nearest level; the same bytes on every
// processor. O(pixels).
GrayImage AreaAveraged(const GrayImage& image, int width, int height);

// Returns an image resized by nearest neighbours: values on both sides of an edge are not mixed.
DepthImage NearestPixels(const DepthImage& image, int width, int height);

}  // namespace plumbline
