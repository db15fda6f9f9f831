// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/stretches.h"

#include "plumbline/base/random.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Parts = std::vector<std::pair<double, double>>;

Parts Ends(const std::vector<Stretch>& parts) {
  Parts ends;
  for (const Stretch& part : parts) ends.emplace_back(part.from, part.to);
  return ends;
}

TEST(Stretches, AreJoinedWhereTheyOverlapOrTouch) {
  const std::vector<Stretch> stretches = {{4, 5}, {0, 1}, {1, 2}, {1.5, 3}};
  EXPECT_EQ(Ends(CoveredAtLeast(stretches, 1)), (Parts{{0, 3}, {4, 5}}));
  EXPECT_DOUBLE_EQ(TotalLength(CoveredAtLeast(stretches, 1)), 4);
  EXPECT_TRUE(CoveredAtLeast({}, 1).empty());
}

TEST(Stretches, AreCountedPlaceByPlace) {
  const std::vector<Stretch> stretches = {{0, 10}, {2, 6}, {4, 8}};
  EXPECT_EQ(Ends(CoveredAtLeast(stretches, 2)), (Parts{{2, 8}}));
  EXPECT_EQ(Ends(CoveredAtLeast(stretches, 3)), (Parts{{4, 6}}));
  EXPECT_TRUE(CoveredAtLeast(stretches, 4).empty());
}

TEST(Stretches, AreComparedWithWhatWasExpected) {
  const std::vector<Stretch> shown = {{0, 10}, {0, 4}};
  const std::vector<Stretch> expected = {{0, 10}, {0, 10}, {0, 10}};
  EXPECT_EQ(Ends(WellCovered(shown, expected, 1, 0.5)), (Parts{{0, 4}}));
  EXPECT_EQ(Ends(WellCovered(shown, expected, 1, 0.3)), (Parts{{0, 10}}));
  // Nothing is expected beyond 6.
  EXPECT_EQ(Ends(WellCovered(shown, std::vector<Stretch>{{0, 6}, {0, 6}, {0, 6}}, 1, 0.5)),
            (Parts{{0, 4}, {6, 10}}));
}

TEST(Stretches, AgreeWithCountingAtRandomPlaces) {
  Rng rng(1, "stretches");
  for (int trial = 0; trial < 50; ++trial) {
    const auto draw = [&] {
      std::vector<Stretch> stretches;
      for (int i = 0; i < 8; ++i) {
        const double from = rng.Uniform(0, 10);
        stretches.push_back({from, from + rng.Uniform(0, 5)});
      }
      return stretches;
    };
    const std::vector<Stretch> stretches = draw(), expected = draw();
    const std::vector<Stretch> parts = WellCovered(stretches, expected, 2, 0.6);
    for (int i = 0; i < 40; ++i) {
      const double place = rng.Uniform(0, 15);
      const auto count = [&](const std::vector<Stretch>& all) {
        return std::count_if(all.begin(), all.end(), [&](const Stretch& s) {
          return s.from <= place && place <= s.to;
        });
      };
      const bool well = count(stretches) >= 2 && static_cast<double>(count(stretches)) >=
                                                     0.6 * static_cast<double>(count(expected));
      EXPECT_EQ(count(parts), well ? 1 : 0) << place;
    }
  }
}

TEST(Stretches, LoseTheirGapsUpToALimit) {
  const std::vector<Stretch> parts = {{0, 1}, {1.5, 2}, {4, 5}};
  EXPECT_EQ(Ends(WithGapsClosed(parts, 0.5)), (Parts{{0, 2}, {4, 5}}));
  EXPECT_EQ(Ends(WithGapsClosed(parts, 0.4)), (Parts{{0, 1}, {1.5, 2}, {4, 5}}));
  EXPECT_EQ(Ends(WithGapsClosed(parts, 2)), (Parts{{0, 5}}));
}

}  // namespace
}  // namespace plumbline
