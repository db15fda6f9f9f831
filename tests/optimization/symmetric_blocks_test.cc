// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/symmetric_blocks.h"

#include "tests/optimization/random_scene.h"
#include <map>
#include <utility>

#include <gtest/gtest.h>

namespace plumbline {
namespace symmetric_blocks_test {

constexpr int kRows = 100;

TEST(SymmetricBlocks, KeepsWhatIsAddedInAnyOrder) {
  for (const bool whole : {false, true}) {
    SymmetricBlocks blocks(kRows, whole);
    testing::Random random(1);
    std::map<std::pair<int, int>, double> expected;
    for (int i = 0; i < 2000; ++i) {
      const int a = random.Index(kRows), b = random.Index(kRows);
      const double value = random.Uniform(-1, 1);
      blocks.At(std::max(a, b), std::min(a, b))(1, 2) += value;
      expected[{std::max(a, b), std::min(a, b)}] += value;
    }
    std::map<std::pair<int, int>, double> found;
    for (int row = 0; row < kRows; ++row) {
      int last = -1;
      blocks.ForEachLeft(row, [&](int column, const Matrix6d& block) {
        EXPECT_GT(column, last);
        last = column;
        EXPECT_EQ(block.cwiseAbs().sum(), std::abs(block(1, 2)));
        if (block(1, 2) != 0) found[{row, column}] = block(1, 2);
      });
      if (blocks.Diagonal(row)(1, 2) != 0) found[{row, row}] = blocks.Diagonal(row)(1, 2);
    }
    EXPECT_EQ(found, expected);
  }
}

TEST(SymmetricBlocks, KeepsOfALargeMatrixWhatWasAskedFor) {
  SymmetricBlocks blocks(kRows, false);
  EXPECT_EQ(blocks.count(), static_cast<std::size_t>(kRows));
  blocks.At(99, 70).setOnes();
  blocks.At(99, 3).setOnes();
  blocks.At(99, 98).setOnes();
  blocks.At(99, 3).setOnes();
  blocks.At(50, 50).setOnes();
  EXPECT_EQ(blocks.count(), static_cast<std::size_t>(kRows) + 3);
  blocks.SetZero();
  EXPECT_EQ(blocks.count(), static_cast<std::size_t>(kRows) + 3);
  EXPECT_EQ(blocks.At(99, 3), Matrix6d::Zero());
  const BlockPattern pattern = blocks.Pattern();
  EXPECT_EQ(pattern[99], (std::vector<int>{3, 70, 98}));
  EXPECT_TRUE(pattern[50].empty());
}

TEST(SymmetricBlocks, KeepsASmallMatrixWhole) {
  const SymmetricBlocks blocks(10, true);
  EXPECT_EQ(blocks.count(), 55U);
  EXPECT_EQ(blocks.Pattern()[9].size(), 9U);
  EXPECT_EQ(SymmetricBlocks(0, true).count(), 0U);
}

}  // namespace symmetric_blocks_test
}  // namespace plumbline
