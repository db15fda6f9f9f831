// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/patches.h"

#include <cmath>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Vector2d;

// A sheet with a block, and another one over its right half.
std::vector<Patch> TwoBlocks() {
  return {{BoxOf(0.1, 0.1, 0.5, 0.5), 0.2}, {BoxOf(0.3, 0.2, 0.7, 0.4), 0.8}};
}

TEST(Patches, TheLastIsOnTop) {
  const auto value = [](double u, double v) {
    return PaintPatches(TwoBlocks(), {u, v}, 0.5, Vector2d::Zero());
  };
  EXPECT_EQ(value(0.05, 0.3), 0.5);
  EXPECT_EQ(value(0.2, 0.3), 0.2);
  EXPECT_EQ(value(0.4, 0.3), 0.8);
  EXPECT_EQ(value(0.4, 0.45), 0.2);
  EXPECT_EQ(value(0.6, 0.3), 0.8);
}

TEST(Patches, CellsOnAnEdgeAreMixedByArea) {
  const Vector2d cell(0.01, 0.02);
  EXPECT_NEAR(PaintPatches(TwoBlocks(), {0.1025, 0.3}, 0.5, cell), 0.25 * 0.5 + 0.75 * 0.2, 1e-12);
  EXPECT_NEAR(PaintPatches(TwoBlocks(), {0.2, 0.095}, 0.5, cell), 0.75 * 0.5 + 0.25 * 0.2, 1e-12);
}

TEST(Patches, HiddenStretchesAreNoEdges) {
  std::vector<Segment2> edges;
  AppendPatchEdges(TwoBlocks(), &edges);
  double right_side = 0, second = 0;
  for (const Segment2& edge : edges) {
    if (edge.start.x() == 0.5 && edge.end.x() == 0.5) {
      right_side += edge.Length();  // of the first block: the second covers 0.2 to 0.4
      EXPECT_TRUE(edge.end.y() <= 0.2 + 1e-12 || edge.start.y() >= 0.4 - 1e-12);
    }
    if (edge.start.y() == 0.2 && edge.end.y() == 0.2) second += edge.Length();
  }
  EXPECT_NEAR(right_side, 0.2, 1e-12);
  EXPECT_NEAR(second, 0.4, 1e-12);
}

TEST(Patches, AnEllipseHidesWhatIsUnderItAndNoMore) {
  Patch disc{BoxOf(0.2, 0.4, 0.4, 0.6), 0.9};
  disc.ellipse = true;
  std::vector<Segment2> edges;
  AppendPatchEdges({{BoxOf(0.1, 0.1, 0.5, 0.55), 0.2}, disc}, &edges);
  double top = 0;
  for (const Segment2& edge : edges) {
    if (edge.start.y() == 0.55 && edge.end.y() == 0.55) top += edge.Length();
  }
  EXPECT_NEAR(top, 0.4 - 2 * std::sqrt(0.01 - 0.0025), 1e-12);
}

TEST(Patches, AStainLetsThroughWhatIsBelow) {
  Patch tape{BoxOf(0.2, 0, 0.3, 1), 1.2};
  tape.stain = true;
  const std::vector<Patch> patches{{BoxOf(0.1, 0.1, 0.5, 0.5), 0.2}, tape};
  EXPECT_NEAR(PaintPatches(patches, {0.25, 0.3}, 0.5, Vector2d::Zero()), 0.24, 1e-12);
  EXPECT_NEAR(PaintPatches(patches, {0.25, 0.7}, 0.5, Vector2d::Zero()), 0.6, 1e-12);
}

}  // namespace
}  // namespace plumbline
