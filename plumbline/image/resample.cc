// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/resample.h"

#include "plumbline/base/error.h"

#include <algorithm>
#include <vector>

namespace plumbline {
namespace {

// Sums of a row over the columns of the target. A pixel of the row is `target` units wide and one
// of the target `source` units, so that a pixel has a part in two sums at most.
void SumColumns(const std::uint8_t* row, std::uint32_t source, std::vector<std::uint32_t>& sums) {
  const auto target = static_cast<std::uint32_t>(sums.size());
  std::uint32_t sum = 0;
  std::uint32_t left = source;  // part of the sum that is still missing
  std::size_t column = 0;
  for (std::uint32_t x = 0; x < source; ++x) {
    const std::uint32_t level = row[x];
    if (left > target) {
      sum += target * level;
      left -= target;
      continue;
    }
    sums[column++] = sum + left * level;
    const std::uint32_t rest = target - left;
    sum = rest * level;
    left = source - rest;
  }
}

}  // namespace

GrayImage AreaAveraged(const GrayImage& image, int width, int height) {
  PLUMBLINE_CHECK(width >= 1 && height >= 1 && width <= image.width() && height <= image.height(),
                  "an image to make smaller");
  const auto source = static_cast<std::uint64_t>(image.height());
  const auto target = static_cast<std::uint64_t>(height);
  const double area = static_cast<double>(image.width()) * image.height();
  GrayImage averaged(width, height);
  std::vector<std::uint32_t> columns(static_cast<std::size_t>(width));
  std::vector<std::uint64_t> sums(columns.size(), 0);
  const auto add = [&](std::uint64_t weight) {
    for (std::size_t x = 0; x < sums.size(); ++x) sums[x] += weight * columns[x];
  };
  std::uint64_t left = source;  // as in SumColumns
  int row = 0;
  for (int y = 0; y < image.height(); ++y) {
    SumColumns(image.row(y), static_cast<std::uint32_t>(image.width()), columns);
    if (left > target) {
      add(target);
      left -= target;
      continue;
    }
    add(left);
    std::uint8_t* const to = averaged.row(row++);
    for (std::size_t x = 0; x < sums.size(); ++x) {
      // The same everywhere: both numbers are whole and less than 2^53.
      to[x] = static_cast<std::uint8_t>(static_cast<double>(sums[x]) / area + 0.5);
    }
    std::fill(sums.begin(), sums.end(), 0);
    add(target - left);
    left = source - (target - left);
  }
  return averaged;
}

DepthImage NearestPixels(const DepthImage& image, int width, int height) {
  PLUMBLINE_CHECK(width >= 1 && height >= 1 && !image.empty(), "an image to resample");
  const auto nearest = [](int i, int target, int source) {
    return static_cast<int>((2 * std::int64_t{i} + 1) * source / (2 * std::int64_t{target}));
  };
  DepthImage chosen(width, height);
  for (int y = 0; y < height; ++y) {
    const float* from = image.row(nearest(y, height, image.height()));
    for (int x = 0; x < width; ++x) chosen.at(x, y) = from[nearest(x, width, image.width())];
  }
  return chosen;
}

}  // namespace plumbline
