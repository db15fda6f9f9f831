// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/cutting_testbed/testbed.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(Testbed, NamesItsCells) {
  EXPECT_EQ(NameOf(SceneOptions{SceneKind::kInverseDepthPoints, 0.015, 20}), "idp/0.015/20");
}

TEST(Testbed, StopsWhenAskedTo) {
  std::size_t calls = 0;
  const TestbedTrials trials =
      RunTestbed(1, TestbedParts::kAll, [&](std::size_t done, std::size_t total) {
        EXPECT_EQ(done, ++calls);
        EXPECT_GT(total, 100U);
        return done < 5;
      });
  EXPECT_EQ(calls, 5U);
  // A cell: three sets of starts and the printed information of single lines, then joint.
  ASSERT_EQ(trials.single.size(), 4U);
  ASSERT_EQ(trials.joint.size(), 1U);
  EXPECT_EQ(trials.single[0].trials.size(), 6U);
  EXPECT_EQ(trials.single[3].information, CuttingInformation::kPrinted);
  EXPECT_EQ(trials.single[3].trials.size(), 1U);
  EXPECT_TRUE(trials.poses.empty());
}

}  // namespace
}  // namespace plumbline
