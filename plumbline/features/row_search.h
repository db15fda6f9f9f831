// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Finds, to the whole pixel, the match of a left pixel in the right image of a rectified pair: the
// pixel in the same row whose window (16 x 11 pixels) of horizontal grey-level slopes has the least
// sum of absolute differences. Slopes are compared because the two cameras may differ in
// brightness. A match is valid if the sum is below `ratio` times that of any other pixel more than
// 2 pixels away and of a window without slopes, and if the search in the opposite direction finds
// the pixel again, which fails for occluded points. Both images must have the same size.
//
// Not thread-safe. Cost: some 2 ns for each pixel of the range, for both directions; the
// constructor makes a few passes over both images.
class RowSearch {
 public:
  static constexpr int kReach = 8;  // half width of a window

  RowSearch(const GrayImage& left, const GrayImage& right);

  // Returns the column in the right image, at least x - max_disparity and at most x + 1 (a point
  // far away, and noise); nullopt if no match is valid, or the window reaches over the border.
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

  GrayImage left_;  // slopes; 128 is zero
  GrayImage right_;
  std::vector<int> sums_;
};

}  // namespace plumbline
