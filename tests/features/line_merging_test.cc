// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/line_merging.h"

#include "plumbline/base/random.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

LineFeature Line(const Segment2& segment) {
  LineFeature line;
  line.segment = segment;
  line.response = 10;
  return line;
}

TEST(CollinearIndex, FindsWhatLookingAtAllFinds) {
  Rng rng(1, "lines");
  std::vector<LineFeature> lines;
  for (int i = 0; i < 400; ++i) {
    // Many almost along the x axis, either way: there angles wrap round.
    const double angle = (i % 2 == 0 ? std::numbers::pi : 0) + rng.Normal(0.03);
    const Eigen::Vector2d middle(rng.Uniform(0, 600), rng.Uniform(0, 20));
    const Eigen::Vector2d half = 20 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    lines.push_back(Line({middle - half, middle + half}));
  }
  const LineMergeLimits limits{2, 1.5, 0.2};
  const CollinearIndex index(lines);
  std::size_t found = 0;
  for (const LineFeature& line : lines) {
    std::vector<std::size_t> expected;
    const Eigen::Vector3d through = LineThrough(line.segment);
    for (std::size_t j = 0; j < lines.size(); ++j) {
      const Segment2& other = lines[j].segment;
      const double cosine = line.segment.Direction().dot(other.Direction());
      if (cosine < std::cos(2 * std::numbers::pi / 180)) continue;
      if (std::abs(LineDistance(through, other.Midpoint())) > 1.5) continue;
      expected.push_back(j);
    }
    EXPECT_EQ(index.Near(line.segment, limits), expected);
    found += expected.size();
  }
  EXPECT_GT(found, 2 * lines.size());
}

TEST(Join, CoversBothPiecesOfOneLine) {
  const GradientImage gradient{Image<std::int16_t>(300, 100), Image<std::int16_t>(300, 100)};
  const LineFeature a = Line({{100, 50}, {200, 50}});
  const LineMergeLimits limits{1.5, 1.2, 0.15};
  const auto joined = Join(gradient, a, Line({{201.5, 50.4}, {260, 50.6}}), limits);
  ASSERT_TRUE(joined);
  EXPECT_EQ(joined->start, Eigen::Vector2d(100, 50));
  EXPECT_EQ(joined->end, Eigen::Vector2d(260, 50.6));
  // Overlapping, on the other side.
  const auto before = Join(gradient, a, Line({{60, 50}, {120, 50.2}}), limits);
  ASSERT_TRUE(before);
  EXPECT_EQ(before->start, Eigen::Vector2d(60, 50));
  EXPECT_EQ(before->end, Eigen::Vector2d(200, 50));
  EXPECT_FALSE(Join(gradient, a, Line({{260, 50}, {202, 50}}), limits)) << "the other way";
  EXPECT_FALSE(Join(gradient, a, Line({{201, 52}, {260, 52}}), limits)) << "beside";
  EXPECT_FALSE(Join(gradient, a, Line({{201, 50}, {230, 51.5}}), limits)) << "turned";
  EXPECT_FALSE(Join(gradient, a, Line({{230, 50}, {290, 50}}), limits)) << "far";
  EXPECT_FALSE(Join(gradient, a, Line({{206, 50}, {266, 50}}), limits)) << "no edge between";
}

}  // namespace
}  // namespace plumbline
