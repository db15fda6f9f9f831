// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/options_without_effect.h"

#include "plumbline/base/options_io.h"
#include "plumbline/slam/preset.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Lines = std::vector<std::string>;

// The lines for these settings, made one after the other.
Lines LinesFor(const std::vector<std::string>& settings,
               std::optional<std::string_view> sensor = {},
               const char* preset = nullptr) {
  SlamOptions options;
  OptionTable table(options);
  if (preset != nullptr) LoadPreset(preset, table);
  Lines keys;
  for (const std::string& setting : settings) {
    table.Set(setting);
    keys.push_back(setting.substr(0, setting.find('=')));
  }
  return OptionsWithoutEffect(options, keys, sensor);
}

TEST(OptionsWithoutEffect, NamesBothOptions) {
  EXPECT_THAT(LinesFor({"cutting.method=greedy", "features.lines=false"}),
              ElementsAre("cutting.method: no effect with features.lines=false"));
  EXPECT_THAT(LinesFor({"initialization.method=rank1_pairwise",
                        "initialization.interpolate=false",
                        "initialization.matching=descriptors"}),
              ElementsAre("initialization.interpolate, initialization.matching: no effect "
                          "with initialization.method=rank1_pairwise"));
}

TEST(OptionsWithoutEffect, IsSilentWhereOptionsHaveOne) {
  EXPECT_THAT(LinesFor({"cutting.method=greedy", "cutting.ends=inverse_depth"}), IsEmpty());
  EXPECT_THAT(LinesFor({"initialization.method=rank1_pairwise"}, "mono"), IsEmpty());
  EXPECT_THAT(LinesFor({"initialization.pairwise.missing=leave_out"}, "mono", "rippl"), IsEmpty());
}

TEST(OptionsWithoutEffect, LeavesOutWhatTheUserHasNotSet) {
  // cutting.method and others are of the preset
  EXPECT_THAT(LinesFor({"features.lines=false"}, "stereo", "good-line-cutting"), IsEmpty());
}

TEST(OptionsWithoutEffect, KnowsTheOtherOptions) {
  struct Case {
    std::vector<std::string> settings;
    const char* line;
  };
  const std::vector<Case> cases = {
      {{"features.lines=false", "features.line_count=9"}, "features.lines=false"},
      {{"features.lines=false", "lines.weighting=none"}, "features.lines=false"},
      {{"features.line_count=0", "features.line.merge=false"}, "features.line_count=0"},
      {{"features.points=false", "features.point_count=9"}, "features.points=false"},
      {{"lines.constant_sigma_px=2"}, "lines.weighting=covariance"},
      {{"cutting.information=printed"}, "cutting.method=none"},
      {{"cutting.ends=inverse_depth"}, "cutting.method=none"},
      {{"cutting.end_sigma=0.01", "cutting.method=greedy"}, "cutting.ends=landmark"},
      {{"initialization.pairwise.missing=leave_out"}, "initialization.method=rank1"},
      {{"initialization.matching=descriptors", "initialization.method=rank1_pairwise"},
       "initialization.method=rank1_pairwise"},
      {{"initialization.reweighting=0", "initialization.factorize=false"},
       "initialization.factorize=false"},
      {{"initialization.min_line_angle_deg=5", "initialization.interpolate=false"},
       "initialization.interpolate=false"},
      {{"lines.reconstruction=n_view_checked", "tracking.reference=last_frame"},
       "tracking.reference=last_frame"},
      {{"tracking.keyframes.max_frames=9", "tracking.reference=last_frame"},
       "tracking.reference=last_frame"},
      {{"relocalization.patience=9", "relocalization.enabled=false"},
       "relocalization.enabled=false"},
      {{"slam.lag=0", "slam.mode=live"}, "slam.mode=live"}};
  for (const Case& c : cases) {
    const Lines lines = LinesFor(c.settings);
    ASSERT_EQ(lines.size(), 1U) << c.settings.front();
    EXPECT_TRUE(lines[0].ends_with(std::string(": no effect with ") + c.line)) << lines[0];
  }
}

TEST(OptionsWithoutEffect, KnowsTheSensor) {
  EXPECT_THAT(LinesFor({"initialization.method=rank1_pairwise", "mapping.lens_calibration=false"},
                       "stereo"),
              ElementsAre("initialization.method, mapping.lens_calibration: no effect with "
                          "--sensor stereo"));
  EXPECT_THAT(LinesFor({"features.depth.max_depth_m=5"}, "stereo"),
              ElementsAre("features.depth.max_depth_m: no effect with --sensor stereo"));
  EXPECT_THAT(LinesFor({"features.depth.max_depth_m=5"}, "rgbd"), IsEmpty());
  EXPECT_THAT(LinesFor({"mapping.stereo_calibration=false"}, "mono"),
              ElementsAre("mapping.stereo_calibration: no effect with --sensor mono"));
}

TEST(OptionsWithoutEffect, CountsTheLinesOfALoadedMap) {
  SlamOptions options;
  options.features.lines = false;
  const Lines set = {"features.line_count", "lines.weighting"};
  EXPECT_THAT(OptionsWithoutEffect(options, set, {}, true),
              ElementsAre("features.line_count: no effect with features.lines=false"));
}

TEST(DifferentOptions, AreThoseOfOtherValues) {
  SlamOptions a, b;
  b.slam.lag = 3;
  b.features.lines = false;
  EXPECT_THAT(DifferentOptions(a, b), ElementsAre("slam.lag", "features.lines"));
  EXPECT_THAT(DifferentOptions(a, a), IsEmpty());
}

}  // namespace
}  // namespace plumbline
