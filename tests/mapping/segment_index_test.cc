// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/segment_index.h"

#include "plumbline/base/random.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr int kWidth = 752, kHeight = 480;
constexpr double kTurn = 2 * std::numbers::pi;

std::vector<Segment2> RandomSegments(Rng& rng, std::size_t count) {
  std::vector<Segment2> segments;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d start(rng.Uniform(-5, kWidth + 5), rng.Uniform(-5, kHeight + 5));
    const double angle = rng.Uniform() < 0.2 ? 0.25 * kTurn * static_cast<double>(rng.Index(5))
                                             : rng.Uniform(-kTurn, kTurn);
    const double length = rng.Uniform(10, 200);
    segments.push_back({start, start + length * Eigen::Vector2d(std::cos(angle), std::sin(angle))});
  }
  return segments;
}

SegmentIndex IndexOf(const std::vector<Segment2>& segments) {
  SegmentIndex index(kWidth, kHeight, segments.size());
  for (std::size_t i = 0; i < segments.size(); ++i) index.Add(i, segments[i]);
  return index;
}

std::vector<std::size_t> Near(const SegmentIndex& index,
                              const Eigen::AlignedBox2d& box,
                              double angle) {
  std::vector<std::size_t> found;
  index.ForEachNear(
      box, {std::cos(angle), std::sin(angle)}, [&](std::size_t i) { found.push_back(i); });
  return found;
}

TEST(SegmentIndex, LeavesOutNothingNearAndParallel) {
  Rng rng(1, "segments");
  for (const std::size_t count : {1U, 63U, 64U, 65U, 300U}) {
    const std::vector<Segment2> segments = RandomSegments(rng, count);
    const SegmentIndex index = IndexOf(segments);
    std::size_t total = 0;
    for (int trial = 0; trial < 200; ++trial) {
      const Eigen::Vector2d corner(rng.Uniform(-100, kWidth), rng.Uniform(-100, kHeight));
      const Eigen::AlignedBox2d box(
          corner, corner + Eigen::Vector2d(rng.Uniform(1, 150), rng.Uniform(1, 150)));
      const double angle = trial % 8 == 0 ? 0.25 * kTurn * trial : rng.Uniform(-kTurn, kTurn);
      const std::vector<std::size_t> found = Near(index, box, angle);
      ASSERT_TRUE(std::is_sorted(found.begin(), found.end()));
      ASSERT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
      total += found.size();
      for (std::size_t i = 0; i < count; ++i) {
        Eigen::AlignedBox2d own(segments[i].start);
        own.extend(segments[i].end);
        const double cosine =
            segments[i].Direction().dot(Eigen::Vector2d(std::cos(angle), std::sin(angle)));
        if (!own.intersects(box) || cosine < 0.95) continue;
        EXPECT_TRUE(std::binary_search(found.begin(), found.end(), i));
      }
    }
    EXPECT_LT(total, 200 * count / 4 + 50) << "some are passed over";
  }
}

TEST(SegmentIndex, TakesABoxWithoutBounds) {
  Rng rng(2, "segments");
  const std::vector<Segment2> segments = RandomSegments(rng, 100);
  const double most = std::numeric_limits<double>::max();
  const Eigen::AlignedBox2d all(Eigen::Vector2d(-most, -most), Eigen::Vector2d(most, most));
  const SegmentIndex index = IndexOf(segments);
  std::vector<bool> found(100, false);
  for (int k = 0; k < 12; ++k) {
    for (const std::size_t i : Near(index, all, kTurn * k / 12)) found[i] = true;
  }
  EXPECT_EQ(std::count(found.begin(), found.end(), true), 100);
}

TEST(SegmentIndex, DoesNotFindWhatIsRemoved) {
  const std::vector<Segment2> segments(70, Segment2{{100, 100}, {200, 100}});
  SegmentIndex index = IndexOf(segments);
  const Eigen::AlignedBox2d box(Eigen::Vector2d(90, 90), Eigen::Vector2d(110, 110));
  ASSERT_EQ(Near(index, box, 0).size(), 70U);
  EXPECT_TRUE(Near(index, box, 0.5 * kTurn).empty()) << "against it";
  index.Remove(66);
  const auto found = Near(index, box, 0);
  EXPECT_EQ(found.size(), 69U);
  EXPECT_FALSE(std::binary_search(found.begin(), found.end(), 66U));
}

TEST(SegmentIndex, HasNothingOfAnEmptyImage) {
  const SegmentIndex index(kWidth, kHeight, 0);
  const Eigen::AlignedBox2d box(Eigen::Vector2d(0, 0), Eigen::Vector2d(110, 110));
  EXPECT_TRUE(Near(index, box, 0).empty());
}

}  // namespace
}  // namespace plumbline
