// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/landmarks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::ElementsAre;
using testing::Pair;

constexpr KeyFrameId kA{3};
constexpr KeyFrameId kB{7};
constexpr KeyFrameId kC{40};

TEST(Observations, AreOrderedByKeyFrameHoweverTheyCame) {
  Observations observations{{kB, 1}, {kA, 2}};
  observations.emplace(kC, 3);
  EXPECT_THAT(observations, ElementsAre(Pair(kA, 2), Pair(kB, 1), Pair(kC, 3)));
  EXPECT_EQ(observations.newest().first, kC);
  EXPECT_EQ(observations, (Observations{{kC, 3}, {kA, 2}, {kB, 1}}));
}

TEST(Observations, KeepTheFirstFeatureOfAKeyFrame) {
  Observations observations{{kA, 2}};
  observations.emplace(kA, 5);
  EXPECT_THAT(observations, ElementsAre(Pair(kA, 2)));
}

TEST(Observations, AreFoundByKeyFrame) {
  const Observations observations{{kA, 2}, {kC, 3}};
  EXPECT_TRUE(observations.contains(kA));
  EXPECT_FALSE(observations.contains(kB));
  EXPECT_EQ(observations.at(kC), 3);
  EXPECT_EQ(observations.find(KeyFrameId{41}), observations.end());
  EXPECT_THROW(observations.at(kB), std::out_of_range);
}

TEST(Observations, AreErasedByKeyFrameOrPlace) {
  Observations observations{{kA, 2}, {kB, 1}, {kC, 3}};
  observations.erase(kB);
  observations.erase(KeyFrameId{8});  // not there: nothing
  EXPECT_THAT(observations, ElementsAre(Pair(kA, 2), Pair(kC, 3)));
  observations.erase(observations.find(kA));
  EXPECT_THAT(observations, ElementsAre(Pair(kC, 3)));
}

}  // namespace
}  // namespace plumbline
