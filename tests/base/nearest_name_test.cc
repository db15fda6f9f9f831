// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/nearest_name.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(EditDistance, CountsInsertionsDeletionsReplacementsSwaps) {
  EXPECT_EQ(EditDistance("", ""), 0U);
  EXPECT_EQ(EditDistance("abc", ""), 3U);
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3U);
  EXPECT_EQ(EditDistance("huber_px", "hubber_px"), 1U);
  EXPECT_EQ(EditDistance("seed", "sede"), 1U);
  EXPECT_EQ(EditDistance("ab", "ba"), 1U);
  EXPECT_EQ(EditDistance("abcd", "badc"), 2U);
  EXPECT_EQ(EditDistance("ca", "abc"), 3U);
}

TEST(NearestName, FindsTheMisspelledName) {
  const std::vector<std::string> names = {"slam.mode", "slam.seed", "ba.huber_px"};
  EXPECT_EQ(NearestName("slam.sede", names), "slam.seed");
  EXPECT_EQ(NearestName("ba.huberpx", names), "ba.huber_px");
}

TEST(NearestName, FindsANameWithoutItsGroup) {
  const std::vector<std::string> names = {"slam.seed", "slam.mode", "ba.huber_px"};
  EXPECT_EQ(NearestName("huber_px", names), "ba.huber_px");
}

TEST(NearestName, FindsANameOfTheMisspelledGroup) {
  const std::vector<std::string> names = {
      "slam.seed", "tracking.reference", "tracking.min_initial"};
  EXPECT_EQ(NearestName("trackng.foo", names), "tracking.reference");
  EXPECT_EQ(NearestName("tracking.initial", names), "tracking.min_initial");
  EXPECT_EQ(NearestName("other.foo", names), std::nullopt);
  EXPECT_EQ(NearestName("foo", names), std::nullopt);
}

TEST(NearestName, IsSilentWhenNothingIsNear) {
  const std::vector<std::string> names = {"slam.seed", "slam.mode"};
  EXPECT_EQ(NearestName("lines.weighting", names), std::nullopt);
}

TEST(NearestName, TakesNoTimeForNamesThatAreNone) {
  const std::vector<std::string> names(1000, "slam.seed");
  EXPECT_EQ(NearestName(std::string(10'000'000, 'x'), names), std::nullopt);
}

TEST(NearestName, TakesTheFirstOfEquallyNear) {
  const std::vector<std::string> names = {"abd", "abe"};
  EXPECT_EQ(NearestName("abc", names), "abd");
}

}  // namespace
}  // namespace plumbline
