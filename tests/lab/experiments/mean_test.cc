// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/mean.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(Mean, IsTheSumByTheCount) {
  EXPECT_EQ(Mean({3}), 3);
  EXPECT_EQ(Mean({1, 2, 6}), 3);
  EXPECT_EQ(Mean({-1, 0.5}), -0.25);
}

}  // namespace
}  // namespace plumbline
