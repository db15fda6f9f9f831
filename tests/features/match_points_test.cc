// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/match_points.h"

#include "plumbline/base/random.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// Random descriptors on a 10-pixel lattice.
std::vector<PointFeature> RandomPoints(int count) {
  Rng rng(5, "points");
  std::vector<PointFeature> points(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    PointFeature& p = points[static_cast<std::size_t>(i)];
    p.px = {10.0 * (i % 20), 10.0 * static_cast<double>(i / 20)};
    for (std::uint64_t& word : p.descriptor) word = rng.Next();
  }
  return points;
}

void FlipBits(int count, PointFeature* point) {
  for (int i = 0; i < count; ++i) {
    const auto bit = static_cast<std::size_t>(5 * i);
    point->descriptor[bit / 64] ^= std::uint64_t{1} << (bit % 64);
  }
}

TEST(MatchPoints, PairsNoisyCopiesInAnotherOrder) {
  const auto a = RandomPoints(100);
  std::vector<PointFeature> b(a.rbegin(), a.rend());
  for (PointFeature& p : b) FlipBits(20, &p);
  const auto matches = MatchPoints(a, b, {});
  ASSERT_EQ(matches.size(), 100U);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(matches[static_cast<std::size_t>(i)].a, i);
    EXPECT_EQ(matches[static_cast<std::size_t>(i)].b, 99 - i);
    EXPECT_EQ(matches[static_cast<std::size_t>(i)].distance, 20);
  }
}

TEST(MatchPoints, FindsTheNearestOfAllAsPairByPair) {
  const auto a = RandomPoints(57);
  auto b = RandomPoints(61);
  for (std::size_t i = 0; i < b.size(); ++i) FlipBits(static_cast<int>(3 * i % 50), &b[i]);
  const auto matches = MatchPoints(a, b, {.max_distance = 256, .ratio = 1});
  for (const FeatureMatch& match : matches) {
    const auto& query = a[static_cast<std::size_t>(match.a)].descriptor;
    int best = 257;
    int index = -1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const int distance = HammingDistance(query, b[j].descriptor);
      if (distance >= best) continue;
      best = distance;
      index = static_cast<int>(j);
    }
    EXPECT_EQ(match.distance, best);
    EXPECT_EQ(match.b, index);
  }
  EXPECT_GT(matches.size(), 40U);
}

// Places that a motion of few matches predicts may be anywhere.
TEST(MatchPoints, SearchesAmongPointsThatAreFarBeyondTheImage) {
  auto a = RandomPoints(60);
  const auto b = a;
  a[7].px = {3e6, 3e6};
  a[9].px = {1e300, -1e300};
  for (const bool swapped : {false, true}) {
    const auto matches =
        swapped ? MatchPoints(b, a, {.radius_px = 25}) : MatchPoints(a, b, {.radius_px = 25});
    EXPECT_EQ(matches.size(), 58U);
  }
}

TEST(MatchPoints, RefusesDistantAmbiguousAndFarAwayCandidates) {
  const auto a = RandomPoints(1);
  PointMatchOptions options;
  auto b = a;
  FlipBits(options.max_distance + 1 > 51 ? 51 : options.max_distance + 1, &b[0]);
  options.max_distance = 50;
  EXPECT_TRUE(MatchPoints(a, b, options).empty());

  b = {a[0], a[0]};
  FlipBits(20, &b[0]);
  FlipBits(22, &b[1]);
  EXPECT_TRUE(MatchPoints(a, b, options).empty());
  options.ratio = 1;
  ASSERT_EQ(MatchPoints(a, b, options).size(), 1U);
  EXPECT_EQ(MatchPoints(a, b, options)[0].b, 0);

  b = a;
  b[0].px.x() += 30;
  options.radius_px = 29;
  EXPECT_TRUE(MatchPoints(a, b, options).empty());
  options.radius_px = 31;
  EXPECT_EQ(MatchPoints(a, b, options).size(), 1U);
  b[0].octave = 3;
  options.max_octave_step = 2;
  EXPECT_TRUE(MatchPoints(a, b, options).empty());
  b[0].octave = 0;
  b[0].angle = 6.2F;  // -5 degrees
  options.max_angle_deg = 4;
  EXPECT_TRUE(MatchPoints(a, b, options).empty());
  options.max_angle_deg = 6;
  EXPECT_EQ(MatchPoints(a, b, options).size(), 1U);
}

TEST(MatchPoints, GivesAPointToItsNearerPartnerOnly) {
  auto a = RandomPoints(1);
  a.push_back(a[0]);
  FlipBits(10, &a[0]);
  const std::vector<PointFeature> b = {a[1]};
  const auto matches = MatchPoints(a, b, {});
  ASSERT_EQ(matches.size(), 1U);
  EXPECT_EQ(matches[0].a, 1);
}

TEST(MatchPoints, OfNothingIsNothing) {
  EXPECT_TRUE(MatchPoints({}, RandomPoints(3), {}).empty());
  EXPECT_TRUE(MatchPoints(RandomPoints(3), {}, {}).empty());
}

}  // namespace
}  // namespace plumbline
