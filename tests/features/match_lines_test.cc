// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/match_lines.h"

#include "tests/features/render.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace match_lines_test {

LineFeature Line(const Eigen::Vector2d& start, const Eigen::Vector2d& end, std::uint64_t word) {
  LineFeature line;
  line.segment = {start, end};
  line.sigma_px = 0.5;
  line.descriptor.fill(word);
  return line;
}

TEST(LinesCompatible, ChecksDirectionOffsetShiftAndLength) {
  const LineMatchOptions options;
  const Segment2 a{{100, 100}, {100, 200}};
  EXPECT_TRUE(LinesCompatible(a, {{110, 105}, {115, 190}}, options));
  EXPECT_FALSE(LinesCompatible(a, a.Reversed(), options));
  EXPECT_FALSE(LinesCompatible(a, {{110, 105}, {150, 180}}, options));  // 28 degrees
  EXPECT_FALSE(LinesCompatible(a, {{190, 100}, {190, 200}}, options));  // 90 px aside
  EXPECT_FALSE(LinesCompatible(a, {{100, 330}, {100, 430}}, options));  // 130 px further on
  EXPECT_FALSE(LinesCompatible(a, {{100, 140}, {100, 160}}, options));  // a fifth as long
  EXPECT_FALSE(LinesCompatible(a, {{100, 140}, {100, 140}}, options));
}

TEST(MatchLines, PairsByDescriptorBothWays) {
  const std::vector<LineFeature> a = {Line({100, 100}, {100, 200}, 0x00ff),
                                      Line({120, 100}, {120, 200}, 0xff00)};
  const std::vector<LineFeature> b = {Line({122, 100}, {122, 200}, 0xff01),
                                      Line({102, 100}, {102, 200}, 0x01ff)};
  const auto matches = MatchLines(a, b, {});
  ASSERT_EQ(matches.size(), 2U);
  EXPECT_EQ(matches[0].b, 1);
  EXPECT_EQ(matches[1].b, 0);
  EXPECT_EQ(matches[0].distance, 4);
}

TEST(MatchLines, IsAmbiguousBetweenTwoEdgesButNotBetweenPiecesOfOne) {
  const std::vector<LineFeature> a = {Line({100, 100}, {100, 200}, 0xff)};
  const LineFeature piece1 = Line({102, 100}, {102, 140}, 0xfe);
  const LineFeature piece2 = Line({102, 150}, {102, 200}, 0xfe);
  const LineFeature other = Line({130, 100}, {130, 200}, 0xfe);
  EXPECT_EQ(MatchLines(a, {piece1, piece2}, {}).size(), 1U);
  EXPECT_TRUE(MatchLines(a, {piece1, other}, {}).empty());
}

TEST(StereoLines, FollowRowsAndPositiveDisparity) {
  const RectifiedCamera camera = TestCamera(640, 480);  // nearest depth 0.25 m: 120 px
  const std::vector<LineFeature> left = {Line({200, 100}, {220, 200}, 0xff)};
  const auto matched = [&](const Eigen::Vector2d& start, const Eigen::Vector2d& end) {
    return MatchStereoLines(camera, left, {Line(start, end, 0xff)}, {})[0].has_value();
  };
  EXPECT_TRUE(matched({180, 100}, {190, 200}));
  EXPECT_TRUE(matched({180, 120}, {190, 240}));
  EXPECT_FALSE(matched({190, 200}, {180, 100}));  // directed the other way
  EXPECT_FALSE(matched({210, 100}, {230, 200}));  // behind the camera
  EXPECT_FALSE(matched({195, 100}, {225, 200}));  // one end behind the camera
  EXPECT_FALSE(matched({60, 100}, {70, 200}));    // too near
  EXPECT_FALSE(matched({180, 170}, {190, 300}));  // hardly any common rows
}

TEST(StereoLines, OfFlatLinesMatchButGiveNoDepth) {
  const RectifiedCamera camera = TestCamera(640, 480);
  const std::vector<LineFeature> left = {Line({200, 100}, {300, 102}, 0xff)};
  const auto right = [&](double dx, double dy) {
    return MatchStereoLines(
        camera, left, {Line({200 - dx, 100 + dy}, {300 - dx, 102 + dy}, 0xff)}, {})[0];
  };
  const std::optional<MeasuredSegment> match = right(30, 0.5);
  ASSERT_TRUE(match);
  EXPECT_FALSE(LineEndDisparities(left[0], *match));
  EXPECT_FALSE(right(30, 8));
  EXPECT_FALSE(right(-80, 0));  // behind the camera
}

TEST(LineEndDisparities, AreMeasuredOnTheRowsOfTheLeftEnds) {
  const LineFeature left = Line({200, 100}, {220, 200}, 0);
  // x = 180 + (y - 100) / 10, seen from row 80 to row 140 only.
  const MeasuredSegment right{{{178, 80}, {184, 140}}, 0.5};
  const auto d = LineEndDisparities(left, right);
  ASSERT_TRUE(d);
  EXPECT_NEAR(d->start.px, 20, 1e-9);
  EXPECT_NEAR(d->end.px, 30, 1e-9);
  EXPECT_GT(d->start.sigma_px, 0.5);
  EXPECT_LT(d->start.sigma_px, 0.75);
  EXPECT_GT(d->end.sigma_px, 1.0);  // a whole length beyond the end of the right segment
  EXPECT_FALSE(LineEndDisparities(left, {{{230, 80}, {236, 140}}, 0.5}));
}

}  // namespace match_lines_test
}  // namespace plumbline
