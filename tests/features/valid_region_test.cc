// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/valid_region.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(ValidRegion, WithoutAMaskEndsAtTheImageBorder) {
  const ValidRegion region(100, 50);
  EXPECT_TRUE(region.Contains({5, 5}, 5));
  EXPECT_FALSE(region.Contains({4.9, 5}, 5));
  EXPECT_TRUE(region.Contains({94, 44}, 5));
  EXPECT_FALSE(region.Contains({94.1, 44}, 5));
}

TEST(ValidRegion, KeepsTheSquareClearOfInvalidPixels) {
  GrayImage mask(100, 50, 255);
  mask.at(40, 20) = 0;
  const ValidRegion region(mask);
  EXPECT_FALSE(region.Contains({40, 20}, 0));
  EXPECT_FALSE(region.Contains({45, 25}, 5));
  EXPECT_TRUE(region.Contains({46, 20}, 5));
  EXPECT_FALSE(region.Contains({46, 20}, 6));
  EXPECT_TRUE(region.Contains({70, 20}, 15));
}

}  // namespace
}  // namespace plumbline
