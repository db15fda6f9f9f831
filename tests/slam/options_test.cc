// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/options.h"

#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"

#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

bool IsRefused(const SlamOptions& options) {
  try {
    CheckOptions(options);
    return false;
  } catch (const InputError&) {
    return true;
  }
}

TEST(CheckOptions, AsksForPointsOrLines) {
  SlamOptions options;
  EXPECT_FALSE(IsRefused(options));
  options.features.points = false;
  EXPECT_FALSE(IsRefused(options));
  options.features.line_count = 0;
  EXPECT_TRUE(IsRefused(options));
  options.features.points = true;
  EXPECT_FALSE(IsRefused(options));
  options.features.point_count = 0;
  EXPECT_TRUE(IsRefused(options));
  options.features.line_count = 100;
  options.features.lines = false;
  EXPECT_TRUE(IsRefused(options));
}

// Numbers that a program sets in the struct itself are held to the bounds of files.
TEST(CheckOptions, HoldsNumbersToTheirBounds) {
  SlamOptions options;
  options.features.point_count = -5;
  try {
    CheckOptions(options);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                ::testing::StartsWith("features.point_count: expected a whole number"));
    EXPECT_THAT(error.what(), ::testing::EndsWith("found -5"));
  }
  options = {};
  options.mapping.line_map.min_mean_length_px = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(IsRefused(options));
}

TEST(CheckOptions, WantsTheLeastBelowTheGreatest) {
  const auto message = [](const SlamOptions& options) -> std::string {
    try {
      CheckOptions(options);
      return "no error";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  SlamOptions options;
  options.features.depth.min_depth_m = options.features.depth.max_depth_m = 4;
  EXPECT_EQ(
      message(options),
      "features.depth.min_depth_m: expected less than features.depth.max_depth_m, 4, found 4");
  options.features.depth.max_depth_m = 4.5;
  EXPECT_EQ(message(options), "no error");
  options.tracking.keyframes.min_frames = 21;
  EXPECT_EQ(message(options),
            "tracking.keyframes.min_frames: expected at most tracking.keyframes.max_frames, 20, "
            "found 21");
  options.tracking.keyframes.max_frames = 21;
  EXPECT_EQ(message(options), "no error");
}

// Methods of the laboratory are none of the product: they are refused when options are read.
TEST(SlamOptions, KnowTheMethodsOfTheProduct) {
  for (const std::string method : {"initialization.method=two_view",
                                   "lines.residual=endpoints",
                                   "lines.reconstruction=two_view",
                                   "cutting.method=joint"}) {
    SlamOptions options;
    EXPECT_THROW(OptionTable(options).Set(method), InputError) << method;
  }
  SlamOptions options;
  OptionTable table(options);
  EXPECT_THAT([&] { table.Set("cutting.method=joint"); },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr(
                  "cutting.method: expected one of none | greedy, found 'joint'")));
  options.cutting.method = "joint";
  EXPECT_THROW(CheckOptions(options), InputError);
}

TEST(CheckOptions, RefusesAResidualOfPosesWithAMap) {
  SlamOptions options;
  options.lines.residual = "projected_ends";
  EXPECT_THAT([&] { CheckOptions(options); },
              ::testing::ThrowsMessage<InputError>(
                  "lines.residual: projected_ends needs tracking.reference last_frame, found "
                  "local_map; maps are adjusted by other residuals"));
  options.tracking.reference = TrackingReference::kLastFrame;
  EXPECT_NO_THROW(CheckOptions(options));
}

// A number without an upper bound keeps the program busy, or asks for memory, without end.
TEST(SlamOptions, EveryNumberHasBounds) {
  SlamOptions options;
  const OptionTable table(options);
  for (const OptionField& field : table.fields()) {
    const bool number = std::visit(
        [](const auto& target) {
          using T = std::decay_t<decltype(target)>;
          return std::is_same_v<T, int*> || std::is_same_v<T, double*> ||
                 std::is_same_v<T, std::int64_t*>;
        },
        field.target);
    if (!number) continue;
    ASSERT_TRUE(field.range) << field.key;
    EXPECT_TRUE(std::isfinite(field.range->min) && std::isfinite(field.range->max)) << field.key;
  }
}

// Folders of runs and maps of 0.2.0 hold all of its options.
TEST(SlamOptions, ReadFilesOf0_2_0) {
  SlamOptions options;
  OptionTable table(options);
  const std::string now = table.Dump();
  std::string earlier;
  for (const RemovedOption& removed : table.removed()) {
    ASSERT_NE(removed.value, "") << removed.name;
    earlier += removed.name + ": " + removed.value + "\n";
  }
  EXPECT_THAT(earlier, ::testing::HasSubstr("lines.parametrization: plucker\n"));
  EXPECT_THAT(earlier, ::testing::HasSubstr("cutting.budget: 0\n"));
  EXPECT_THAT(earlier, ::testing::HasSubstr("tracking.max_pose_sigma: 0.02\n"));
  EXPECT_THAT(earlier, ::testing::HasSubstr("features.stereo_lines.ratio: 0.9\n"));
  EXPECT_THAT(earlier, ::testing::HasSubstr("mapping.ba.function_tolerance: 0.001\n"));
  table.LoadText(now + earlier, "earlier");
  EXPECT_EQ(table.Dump(), now);
  table.LoadText("mapping:\n  creation:\n  window: {free_keyframes: 12}\n", "groups");
  try {
    table.LoadText("mapping:\n  window: {free_keyframes: 20}\n", "other.yaml");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "other.yaml:2: mapping.window.free_keyframes is no option any more: it is fixed "
                 "at 12 (LocalBaWindowOptions::free_keyframes), found '20'");
  }
}

}  // namespace
}  // namespace plumbline
