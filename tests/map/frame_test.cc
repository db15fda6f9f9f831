// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/frame.h"

#include "tests/support/random_geometry.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(WithCorrection, CorrectsACopyAndRemembersTheCorrection) {
  auto features = std::make_shared<IndexedFeatures>();
  features->features.points.resize(1);
  features->features.point_disparity = {Disparity{10, 1}};
  const std::shared_ptr<const IndexedFeatures> raw = features;
  const StereoCorrection half(TestCamera(), 0.5 * Vector6d::Unit(0));
  const auto corrected = WithCorrection(raw, half);
  EXPECT_DOUBLE_EQ(raw->features.point_disparity[0]->px, 10);
  EXPECT_DOUBLE_EQ(corrected->features.point_disparity[0]->px, 9.5);
  EXPECT_EQ(corrected->correction, half);
  EXPECT_DOUBLE_EQ(WithCorrection(corrected, {})->features.point_disparity[0]->px, 10);
}

TEST(WithCorrection, SharesFeaturesThatHaveTheCorrection) {
  const auto raw = std::make_shared<const IndexedFeatures>();
  EXPECT_EQ(WithCorrection(raw, {}), raw);
}

}  // namespace
}  // namespace plumbline
