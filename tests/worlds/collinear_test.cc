// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/collinear.h"

#include "plumbline/base/random.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Vector3d;

Segment3 AlongX(double from, double to, double y = 0) { return {{from, y, 1}, {to, y, 1}}; }

Vector3d RandomPoint(Rng& rng) {
  return {rng.Uniform(-5, 5), rng.Uniform(-5, 5), rng.Uniform(0, 3)};
}

TEST(SegmentGrid, FindsWhatAFullSearchFinds) {
  Rng rng(1);
  std::vector<Segment3> segments;
  for (int i = 0; i < 3000; ++i) {
    const Vector3d start = RandomPoint(rng);
    segments.push_back({start, start + rng.Uniform(0.05, 1) * (RandomPoint(rng) - start)});
  }
  const SegmentGrid grid(segments);
  std::size_t found = 0;
  for (int i = 0; i < 2000; ++i) {
    // Beside some segment, so that there is something to find.
    const Segment3& beside = segments[rng.Index(segments.size())];
    const Vector3d point = beside.start + rng.Uniform() * (beside.end - beside.start) +
                           0.02 * RandomPoint(rng).normalized();
    std::vector<int> expected;
    for (std::size_t j = 0; j < segments.size(); ++j) {
      if (Distance(segments[j], point) <= 0.09) expected.push_back(static_cast<int>(j));
    }
    found += expected.size();
    ASSERT_EQ(grid.Near(point, 0.09), expected);
  }
  EXPECT_GT(found, 2000U);
}

TEST(JoinCollinear, OverlapsAndNeighboursBecomeOne) {
  // The same twice, one overlapping, one touching; one beyond a gap; one beside; one across.
  const std::vector<Segment3> segments{AlongX(0, 1),
                                       AlongX(3, 4, 0.01),
                                       AlongX(1, 0),
                                       AlongX(0.5, 2, 0.0005),
                                       AlongX(2.0005, 2.4),
                                       AlongX(2.5, 3),
                                       {{0.5, -1, 1}, {0.5, 1, 1}}};
  const auto joined = JoinCollinear(segments, 0.001);
  ASSERT_EQ(joined.size(), 4U);
  EXPECT_NEAR(joined[0].Length(), 2.4, 1e-6);  // in the place of its first
  EXPECT_NEAR(joined[1].start.y(), 0.01, 1e-12);
  EXPECT_NEAR(joined[2].Length(), 0.5, 1e-12);
  EXPECT_NEAR(joined[3].Length(), 2, 1e-12);
}

TEST(JoinCollinear, ShortPiecesInsideALongOneVanish) {
  std::vector<Segment3> segments{AlongX(0, 20)};
  for (int i = 0; i < 50; ++i) segments.push_back(AlongX(0.3 * i, 0.3 * i + 0.1));
  const auto joined = JoinCollinear(segments, 0.001);
  ASSERT_EQ(joined.size(), 1U);
  EXPECT_NEAR(joined[0].Length(), 20, 1e-9);
}

TEST(Uncovered, LeavesTheRest) {
  const std::vector<Segment3> covers{AlongX(1, 2, 0.001),
                                     AlongX(1.5, 2.5),
                                     AlongX(6, 5),
                                     AlongX(3, 4, 0.01),
                                     {{7, 0, 0}, {7, 0, 2}}};
  const SegmentGrid grid(covers);
  const auto rest = Uncovered(AlongX(0, 9), covers, grid, 0.002, 0.05);
  std::vector<double> ends;
  for (const Segment3& part : rest) {
    ends.push_back(part.start.x());
    ends.push_back(part.end.x());
  }
  EXPECT_THAT(ends, testing::Pointwise(testing::DoubleNear(0.003), {0.0, 1.0, 2.5, 5.0, 6.0, 9.0}));
  EXPECT_TRUE(Uncovered(AlongX(1.1, 2.4), covers, grid, 0.002, 0.05).empty());
  EXPECT_TRUE(Uncovered(AlongX(0.97, 2.4), covers, grid, 0.002, 0.05).empty());  // 3 cm are left
}

}  // namespace
}  // namespace plumbline
