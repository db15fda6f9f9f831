// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_maps/surface_distance.h"

#include "tests/support/random_geometry.h"
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Vector3d;

TEST(SurfaceDistance, OfALineThatLeavesAWallGrowsEvenly) {
  const Parallelogram wall{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}};
  const Segment3 line{{0, 0, 0}, {0, 0, 0.2}};
  const auto distance = DistanceFromSurfaces({{line}}, {{wall}}, 0.05);
  ASSERT_TRUE(distance);
  EXPECT_NEAR(distance->median, 0.1, 0.0051);
  EXPECT_NEAR(distance->share_beyond, 0.75, 0.026);
}

TEST(SurfaceDistance, WeighsPiecesWithTheirLength) {
  const Parallelogram wall{{-9, -9, 0}, {18, 0, 0}, {0, 18, 0}};
  const std::vector<Segment3> pieces = {
      {{0, 0, 0.01}, {3, 0, 0.01}}, {{0, 0, 0.5}, {0.5, 0, 0.5}}, {{0, 1, 0.3}, {0.5, 1, 0.3}}};
  const auto distance = DistanceFromSurfaces(pieces, {{wall}}, 0.05);
  EXPECT_NEAR(distance->median, 0.01, 1e-12);
  EXPECT_NEAR(distance->share_beyond, 0.25, 1e-9);
}

TEST(SurfaceDistance, FindsTheNearestOfManySurfaces) {
  Rng rng(8);
  std::vector<Parallelogram> surfaces;
  for (int i = 0; i < 200; ++i) {
    surfaces.push_back(
        {RandomVector<3>(rng), RandomVector<3>(rng, 0.2), RandomVector<3>(rng, 0.2)});
  }
  for (int i = 0; i < 20; ++i) {
    // Shorter than a cell: one distance, from the middle.
    const Vector3d point = RandomVector<3>(rng), tiny(1e-4, 0, 0);
    double nearest = Distance(surfaces[0], point);
    for (const Parallelogram& surface : surfaces) {
      nearest = std::min(nearest, Distance(surface, point));
    }
    const auto one = DistanceFromSurfaces({{{point - tiny, point + tiny}}}, surfaces, nearest);
    EXPECT_NEAR(one->median, nearest, 1e-12);
    // The same point as the middle of a longer piece, all of it searched in parts.
    const Segment3 piece{point - Vector3d(0.7, 0.3, 0.2), point + Vector3d(0.7, 0.3, 0.2)};
    std::vector<double> sampled;
    for (int k = 0; k < 1000; ++k) {
      const Vector3d at = piece.start + (k + 0.5) / 1000 * (piece.end - piece.start);
      double least = Distance(surfaces[0], at);
      for (const Parallelogram& surface : surfaces) least = std::min(least, Distance(surface, at));
      sampled.push_back(least);
    }
    std::sort(sampled.begin(), sampled.end());
    const auto whole = DistanceFromSurfaces({{piece}}, surfaces, sampled[700]);
    EXPECT_NEAR(whole->median, sampled[500], 0.005);
    EXPECT_NEAR(whole->share_beyond, 0.3, 0.02);
  }
}

TEST(SurfaceDistance, NeedsSurfacesAndLength) {
  const Segment3 line{{0, 0, 0}, {0, 0, 1}};
  EXPECT_FALSE(DistanceFromSurfaces({{line}}, {}, 0.05));
  EXPECT_FALSE(DistanceFromSurfaces({}, {{Parallelogram{}}}, 0.05));
  EXPECT_FALSE(DistanceFromSurfaces({{{line.start, line.start}}}, {{Parallelogram{}}}, 0.05));
}

TEST(SurfaceDistance, OfHugePiecesTakesLongerCells) {
  const Segment3 line{{0, 0, 0}, {0, 0, 1e7}};
  const auto distance = DistanceFromSurfaces({{line}}, {{Parallelogram{}}}, 0.05);
  EXPECT_NEAR(distance->median, 5e6, 100);
}

}  // namespace
}  // namespace plumbline
