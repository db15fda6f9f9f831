// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/box_filter.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(BoxFilter, SpreadsASpotEvenlyOverItsWindow) {
  GrayImage image(9, 7);
  image.at(4, 3) = 250;
  const GrayImage filtered = BoxFiltered(image, 5);
  ASSERT_EQ(filtered.width(), 9);
  ASSERT_EQ(filtered.height(), 7);
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 9; ++x) {
      const bool inside = x >= 2 && x <= 6 && y >= 1 && y <= 5;
      EXPECT_EQ(filtered.at(x, y), inside ? 10 : 0) << x << ", " << y;
    }
  }
}

TEST(BoxFilter, RepeatsTheBorder) {
  GrayImage image(4, 4);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) image.at(x, y) = 77;
  }
  EXPECT_EQ(BoxFiltered(image, 3).at(0, 0), 77);
  EXPECT_EQ(BoxFiltered(image, 3).at(3, 3), 77);
}

TEST(BoxFilter, SizeOneChangesNothing) {
  GrayImage image(3, 2);
  image.at(2, 1) = 9;
  const GrayImage filtered = BoxFiltered(image, 1);
  EXPECT_EQ(filtered.at(2, 1), 9);
  EXPECT_EQ(filtered.at(1, 1), 0);
}

}  // namespace
}  // namespace plumbline
