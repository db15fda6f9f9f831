// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/row_search.h"

#include "plumbline/base/error.h"
#include "plumbline/image/opencv_bridge.h"

#include <algorithm>
#include <cstdlib>

#include <opencv2/imgproc.hpp>

namespace plumbline {
namespace {

// Sixteen bytes are one instruction's worth.
constexpr int kWindowWidth = 2 * RowSearch::kReach;
constexpr int kBefore = RowSearch::kReach;  // pixels of a window left of its place
constexpr int kHalfHeight = 5;
constexpr int kNone = 128;  // no slope

// Derivative along the row, smoothed over three rows (Sobel), halved, kNone where there is none.
// Saturates where grey levels two pixels apart differ by more than 64.
GrayImage Slopes(const GrayImage& image) {
  cv::Mat slopes;
  cv::Sobel(AsMat(image), slopes, CV_16S, 1, 0);
  GrayImage result(image.width(), image.height());
  cv::Mat target = AsMat(result);
  slopes.convertTo(target, CV_8U, 0.5, kNone);
  return result;
}

int SumOfDifferences(const GrayImage& a, const GrayImage& b, int ax, int bx, int y) {
  int sum = 0;
  for (int dy = -kHalfHeight; dy <= kHalfHeight; ++dy) {
    const std::uint8_t* row_a = a.row(y + dy) + ax - kBefore;
    const std::uint8_t* row_b = b.row(y + dy) + bx - kBefore;
    for (int i = 0; i < kWindowWidth; ++i) sum += std::abs(row_a[i] - row_b[i]);
  }
  return sum;
}

// The sum of differences from a window without any slope.
int SumOfSlopes(const GrayImage& slopes, const Eigen::Vector2i& at) {
  int sum = 0;
  for (int dy = -kHalfHeight; dy <= kHalfHeight; ++dy) {
    const std::uint8_t* row = slopes.row(at.y() + dy) + at.x() - kBefore;
    for (int i = 0; i < kWindowWidth; ++i) sum += std::abs(row[i] - kNone);
  }
  return sum;
}

}  // namespace

RowSearch::RowSearch(const GrayImage& left, const GrayImage& right)
    : left_(Slopes(left)), right_(Slopes(right)) {
  PLUMBLINE_CHECK(left.width() == right.width() && left.height() == right.height(),
                  "images of one size");
}

std::optional<int> RowSearch::Find(const Eigen::Vector2i& left, int max_disparity, double ratio) {
  const int y = left.y();
  const std::optional<int> x =
      Best(left_, left, right_, {left.x() - max_disparity, left.x() + 1}, ratio);
  if (!x) return std::nullopt;
  const std::optional<int> back = Best(right_, {*x, y}, left_, {*x - 1, *x + max_disparity}, ratio);
  if (!back || std::abs(*back - left.x()) > 1) return std::nullopt;
  return x;
}

std::optional<int> RowSearch::Best(const GrayImage& from,
                                   const Eigen::Vector2i& at,
                                   const GrayImage& to,
                                   Columns columns,
                                   double ratio) {
  constexpr int kSamePlace = 2;
  const auto fits = [&](int x) { return x >= kBefore && x + kWindowWidth - kBefore <= to.width(); };
  if (at.y() < kHalfHeight || at.y() + kHalfHeight >= to.height() || !fits(at.x())) {
    return std::nullopt;
  }
  const int first = std::max(columns.first, kBefore);
  const int last = std::min(columns.last, to.width() - (kWindowWidth - kBefore));
  if (first > last) return std::nullopt;
  sums_.resize(static_cast<std::size_t>(last - first + 1));
  for (int x = first; x <= last; ++x) {
    sums_[static_cast<std::size_t>(x - first)] = SumOfDifferences(from, to, at.x(), x, at.y());
  }
  const auto least = std::min_element(sums_.begin(), sums_.end());
  const auto best = static_cast<int>(least - sums_.begin());
  int second = SumOfSlopes(from, at);
  for (int k = 0; k < static_cast<int>(sums_.size()); ++k) {
    if (std::abs(k - best) > kSamePlace) {
      second = std::min(second, sums_[static_cast<std::size_t>(k)]);
    }
  }
  if (*least >= ratio * second) return std::nullopt;
  return first + best;
}

}  // namespace plumbline
