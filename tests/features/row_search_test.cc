// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/row_search.h"

#include "plumbline/image/opencv_bridge.h"

#include "tests/features/render.h"
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace plumbline {
namespace row_search_test {

constexpr int kWidth = 320;
constexpr int kHeight = 120;
constexpr double kRatio = 0.9;

// What a right camera sees whose image is moved by `shift` and darker.
GrayImage Shifted(const SquareTexture& texture, double shift) {
  return Render(kWidth, kHeight, [&](const Eigen::Vector2d& p) {
    return 0.9 * texture(p + Eigen::Vector2d(shift, 0)) - 10;
  });
}

// Every seventh pixel that has room for the window and the shift.
template <class Visit>
void ForPixels(Visit visit) {
  for (int y = 10; y < kHeight - 10; y += 7) {
    for (int x = 60; x < kWidth - 20; x += 7) visit(Eigen::Vector2i(x, y));
  }
}

TEST(RowSearch, FindsAKnownShiftInADarkerImage) {
  const SquareTexture texture(400, kWidth, kHeight);
  RowSearch search(Shifted(texture, 0), Shifted(texture, 21));
  int right = 0;
  int wrong = 0;
  int all = 0;
  ForPixels([&](const Eigen::Vector2i& at) {
    const std::optional<int> x = search.Find(at, 40, kRatio);
    ++all;
    if (x) ++(*x == at.x() - 21 ? right : wrong);
  });
  EXPECT_GT(right, 0.8 * all);
  EXPECT_LT(wrong, 0.01 * all);
}

TEST(RowSearch, FindsNothingOnAPatternThatRepeats) {
  const auto stripes = [](const Eigen::Vector2d& p) {
    return 128 + 60 * std::sin(p.x() * std::numbers::pi / 4) + 30 * std::sin(p.y() * 0.3);
  };
  const GrayImage image = Render(kWidth, kHeight, stripes);
  RowSearch search(image, image);
  ForPixels([&](const Eigen::Vector2i& at) { EXPECT_FALSE(search.Find(at, 40, kRatio)); });
}

TEST(RowSearch, FindsNothingWhereTheRightImageShowsSomethingElse) {
  const SquareTexture texture(400, kWidth, kHeight);
  const GrayImage left = Shifted(texture, 0);
  RowSearch flat(left, GrayImage(kWidth, kHeight, 90));
  RowSearch out_of_range(left, Shifted(texture, 55));
  int found = 0;
  int all = 0;
  ForPixels([&](const Eigen::Vector2i& at) {
    EXPECT_FALSE(flat.Find(at, 40, kRatio));
    found += out_of_range.Find(at, 40, kRatio) ? 1 : 0;
    ++all;
  });
  EXPECT_LT(found, 0.1 * all);
}

TEST(RowSearch, StaysInsideTheImages) {
  const SquareTexture texture(400, kWidth, kHeight);
  RowSearch search(Shifted(texture, 0), Shifted(texture, 3));
  for (int y = 0; y < kHeight; ++y) {
    for (const int x : {0, 7, 8, 12, kWidth - 9, kWidth - 8, kWidth - 1}) {
      const std::optional<int> found = search.Find({x, y}, 1000, kRatio);
      if (!found) continue;
      EXPECT_GE(y, 5);
      EXPECT_LE(y, kHeight - 6);
      EXPECT_GE(*found, 8);
      EXPECT_LE(*found, kWidth - 8);
    }
  }
}

// Horizontal slopes as the search compares them, by OpenCV.
GrayImage SlopesOf(const GrayImage& image) {
  cv::Mat slopes;
  cv::Sobel(AsMat(image), slopes, CV_16S, 1, 0);
  GrayImage result(image.width(), image.height());
  cv::Mat target = AsMat(result);
  slopes.convertTo(target, CV_8U, 0.5, 128);
  return result;
}

// By the sums over all rows at all places.
std::optional<int> BestOfAll(
    const GrayImage& from, const Eigen::Vector2i& at, const GrayImage& to, int first, int last) {
  const auto level = [](const GrayImage& image, int x, int y) { return int{image.at(x, y)}; };
  const auto sum_at = [&](auto&& other) {
    int sum = 0;
    for (int dy = -5; dy <= 5; ++dy) {
      for (int dx = -8; dx < 8; ++dx) {
        sum += std::abs(level(from, at.x() + dx, at.y() + dy) - other(dx, at.y() + dy));
      }
    }
    return sum;
  };
  std::vector<int> sums;
  first = std::max(first, 8);
  for (int x = first; x <= std::min(last, kWidth - 8); ++x) {
    sums.push_back(sum_at([&](int dx, int y) { return level(to, x + dx, y); }));
  }
  const auto best = static_cast<int>(std::min_element(sums.begin(), sums.end()) - sums.begin());
  int second = sum_at([](int, int) { return 128; });
  for (int k = 0; k < static_cast<int>(sums.size()); ++k) {
    if (std::abs(k - best) > 2) second = std::min(second, sums[static_cast<std::size_t>(k)]);
  }
  if (sums[static_cast<std::size_t>(best)] >= kRatio * second) return std::nullopt;
  return first + best;
}

TEST(RowSearch, FindsWhatTheSumsOverAllRowsAtAllPlacesTell) {
  const SquareTexture texture(400, kWidth, kHeight);
  const GrayImage left = Shifted(texture, 0);
  const GrayImage right = Render(kWidth, kHeight, [&](const Eigen::Vector2d& p) {
    return texture(p + Eigen::Vector2d(10 + 0.1 * p.y(), 0)) + 40 * std::sin(p.x() * p.y());
  });
  RowSearch search(left, right);
  const GrayImage slopes_left = SlopesOf(left);
  const GrayImage slopes_right = SlopesOf(right);
  int found = 0;
  int missed = 0;
  ForPixels([&](const Eigen::Vector2i& at) {
    std::optional<int> expected = BestOfAll(slopes_left, at, slopes_right, at.x() - 40, at.x() + 1);
    if (expected) {
      const auto back =
          BestOfAll(slopes_right, {*expected, at.y()}, slopes_left, *expected - 1, *expected + 40);
      if (!back || std::abs(*back - at.x()) > 1) expected.reset();
    }
    EXPECT_EQ(search.Find(at, 40, kRatio), expected) << at.transpose();
    ++(expected ? found : missed);
  });
  EXPECT_GT(found, 50);
  EXPECT_GT(missed, 50);
}

TEST(RowSearch, FindsNothingInImagesSmallerThanTheWindow) {
  const SquareTexture texture(40, 20, 20);
  const GrayImage image = Render(10, 8, texture);
  RowSearch search(image, image);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 10; ++x) EXPECT_FALSE(search.Find({x, y}, 5, kRatio));
  }
  EXPECT_THROW(RowSearch(image, GrayImage(10, 9)), BugError);
}

}  // namespace row_search_test
}  // namespace plumbline
