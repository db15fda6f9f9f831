// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/true_line.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(TrueLine, CountsTheFramesOfItsRanges) {
  TrueLine line;
  EXPECT_FALSE(line.VisibleFrames());
  line.visible.emplace();
  EXPECT_EQ(line.VisibleFrames(), 0);
  line.visible = {{0, 17}, {25, 25}, {30, 44}};
  EXPECT_EQ(line.VisibleFrames(), 18 + 1 + 15);
}

}  // namespace
}  // namespace plumbline
