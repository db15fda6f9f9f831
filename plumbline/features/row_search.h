// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Finds where the right image of a rectified pair shows what the left one shows at a pixel, to the
// whole pixel: the place in the same row whose window (16 x 11 pixels) of horizontal grey-level
// slopes has the least sum of absolute differences. Slopes, because the two cameras may differ in
// brightness. A place counts if the sum is below `ratio` times that of any other place more
// than 2 pixels away and of a window without slopes, and if the way back finds the pixel again:
// what only one camera sees fails this. Both images have the same size.
//
// Not for several threads at once. Cost: some 2 ns for each pixel of the range, both
// ways; the constructor, a few passes over both images.
class RowSearch {
 public:
  static constexpr int kReach = 8;  // of a window from its place along the row

  RowSearch(const GrayImage& left, const GrayImage& right);

  // Column in the right image, at least x - max_disparity and at most x + 1 (a point far away,
  // and noise); nullopt if there is none, or the window reaches over the border.
  std::optional<int> Find(const Eigen::Vector2i& left, int max_disparity, double ratio);

 private:
  struct Columns {
    int first;
    int last;
  };

  std::optional<int> Best(const GrayImage& from,
                          const Eigen::Vector2i& at,
                          const GrayImage& to,
                          Columns columns,
                          double ratio);

  GrayImage left_;  // slopes, 128: none
  GrayImage right_;
  std::vector<int> sums_;
};

}  // namespace plumbline
