// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/front_end_fingerprint.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(FrontEndFingerprint, LeavesOutWhatChangesNoResult) {
  FeatureOptions options;
  options.parallel = !options.parallel;
  EXPECT_EQ(FingerprintOf(options), FingerprintOf({}));
}

TEST(FrontEndFingerprint, SaysWhatDiffers) {
  const FrontEndFingerprint before = FingerprintOf({});
  EXPECT_TRUE(Differences(before, before).empty());
  FeatureOptions options;
  options.line_count = 100;
  options.orb.scale_factor = 1.5;
  FrontEndFingerprint now = FingerprintOf(options);
  EXPECT_EQ(Differences(before, now),
            (std::vector<std::string>{"features.line_count: 200 in the map, 100 now",
                                      "features.orb.scale_factor: 1.2 in the map, 1.5 now"}));
  now = before;
  ++now.feature_format;
  now.settings.erase("features.lines");
  EXPECT_EQ(Differences(before, now),
            (std::vector<std::string>{"format of features: 1 in the map, 2 now",
                                      "features.lines: true in the map, no such option now"}));
}

// A map of an earlier version may have been measured with another value of what is a constant now.
TEST(FrontEndFingerprint, HoldsWhatWasAnOption) {
  const FrontEndFingerprint now = FingerprintOf({});
  FrontEndFingerprint before = now;
  EXPECT_EQ(before.settings.at("features.orb.levels"), "8");
  before.settings["features.orb.levels"] = "4";
  EXPECT_EQ(Differences(before, now),
            std::vector<std::string>{"features.orb.levels: 4 in the map, 8 now"});
}

TEST(FrontEndFingerprint, KnowsNothingOfMapsThatDoNotSay) {
  EXPECT_TRUE(Differences({}, FingerprintOf({})).empty());
}

}  // namespace
}  // namespace plumbline
