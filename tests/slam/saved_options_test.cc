// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/saved_options.h"

#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"
#include "plumbline/features/extractor.h"
#include "plumbline/slam/preset.h"

#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(SavedOptions, AreThoseOfTheMapsOrTheDefaultOnes) {
  AtlasContext context;
  const auto none = [](const RemovedSetting& removed) { ADD_FAILURE() << removed.message; };
  EXPECT_EQ(SavedOptions(context, "m.plb", none).mapping.line_map.min_keyframes,
            SlamOptions{}.mapping.line_map.min_keyframes);
  context.options_yaml = "mapping: {line_map: {min_keyframes: 7}}";
  EXPECT_EQ(SavedOptions(context, "m.plb", none).mapping.line_map.min_keyframes, 7);
  context.options_yaml = "mapping: {of_a_later_version: 7}";
  try {
    SavedOptions(context, "m.plb", none);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("m.plb:1: unknown option 'mapping.of_a_later"), 0U);
  }
}

TEST(SavedOptionsOrDefault, AreTheDefaultOnesWithARemarkWhereTheyAreNotKnown) {
  std::vector<std::string> remarks;
  const auto remark = [&](const std::string& text) { remarks.push_back(text); };
  AtlasContext context;
  context.options_yaml = "mapping: {line_map: {min_keyframes: 7}}";
  const auto keyframes = [&](const std::function<void(SlamOptions&)>& accept) {
    return SavedOptionsOrDefault(context, "m.plb", "lines as by default", remark, accept)
        .mapping.line_map.min_keyframes;
  };
  EXPECT_EQ(keyframes({}), 7);
  EXPECT_EQ(keyframes([](SlamOptions& options) { options.mapping.line_map.min_keyframes = 9; }), 9);
  EXPECT_TRUE(remarks.empty());
  const int usual = SlamOptions{}.mapping.line_map.min_keyframes;
  EXPECT_EQ(keyframes([](SlamOptions&) { throw InputError("none of ours"); }), usual);
  context.options_yaml = "mapping: {of_a_later_version: 7}";
  EXPECT_EQ(keyframes({}), usual);
  ASSERT_EQ(remarks.size(), 2U);
  EXPECT_EQ(remarks[0], "none of ours; lines as by default");
  EXPECT_EQ(remarks[1].find("m.plb:1: unknown option 'mapping.of_a_later_version'"), 0U);
  EXPECT_NE(remarks[1].find("; lines as by default"), std::string::npos);
}

// A map of 0.2.0 holds options that are constants now.
TEST(SavedOptionsOrDefault, TellWhatWasRemovedSinceAndHadAnotherValue) {
  std::vector<std::string> remarks;
  AtlasContext context;
  context.options_yaml =
      "mapping:\n  ba: {rounds: 2, max_iterations: 20}\n  line_map: {min_keyframes: 7}\n";
  const SlamOptions options =
      SavedOptionsOrDefault(context, "m.plb", "lines as by default", [&](const std::string& text) {
        remarks.push_back(text);
      });
  EXPECT_EQ(options.mapping.line_map.min_keyframes, 7);
  EXPECT_EQ(options.mapping.ba.max_iterations, MappingOptions{}.ba.max_iterations);
  EXPECT_EQ(remarks,
            std::vector<std::string>{"m.plb:2: mapping.ba.max_iterations is no option any more: it "
                                     "is fixed at 10 (MappingOptions::ba), found '20'"});
}

AtlasContext MeasuredWith(const std::string& options_yaml) {
  AtlasContext context;
  context.feature_format = kFeatureFormat;
  context.options_yaml = options_yaml;
  return context;
}

// A map of the laboratory names methods that the product does not have.
TEST(SavedOptionsOrDefault, TellOfMethodsThatThisProgramDoesNotHave) {
  std::vector<std::string> remarks;
  AtlasContext context;
  context.options_yaml = "cutting:\n  method: joint\nmapping:\n  line_map: {min_keyframes: 7}\n";
  const auto read = [&](const std::vector<AddedMethod>& added) {
    return SavedOptionsOrDefault(
        context,
        "m.plb",
        "lines as by default",
        [&](const std::string& text) { remarks.push_back(text); },
        {},
        added);
  };
  const SlamOptions options = read({});
  EXPECT_EQ(options.cutting.method, "none");
  EXPECT_EQ(options.mapping.line_map.min_keyframes, 7);
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_EQ(remarks[0], "m.plb:2: cutting.method: expected one of none | greedy, found 'joint'");
  EXPECT_EQ(read({{"cutting.method", "joint", "all at once"}}).cutting.method, "joint");
  EXPECT_EQ(remarks.size(), 1U);
}

TEST(FrontEndDifferences, SayWhatIsNotTheSame) {
  const AtlasContext before = MeasuredWith("features: {line_count: 150}");
  EXPECT_TRUE(FrontEndDifferences(before, before).empty());
  const AtlasContext now = MeasuredWith("features: {line_count: 100, orb.scale_factor: 1.5}");
  EXPECT_EQ(FrontEndDifferences(before, now),
            (std::vector<std::string>{"features.line_count: 150 in the map, 100 now",
                                      "features.orb.scale_factor: 1.2 in the map, 1.5 now"}));
  AtlasContext later = before;
  ++later.feature_format;
  EXPECT_EQ(FrontEndDifferences(before, later),
            std::vector<std::string>{"format of features: 1 in the map, 2 now"});
}

TEST(FrontEndDifferences, CountOptionsThatWereRemovedSince) {
  const AtlasContext before = MeasuredWith("features: {orb: {sigma_px: 0.5}}");
  EXPECT_EQ(FrontEndDifferences(before, MeasuredWith("")),
            std::vector<std::string>{"features.orb.sigma_px: 0.5 in the map, 0.2 now"});
  EXPECT_TRUE(FrontEndDifferences(before, before).empty());
  EXPECT_TRUE(FrontEndDifferences(MeasuredWith("mapping: {ba: {rounds: 5}}"), before).size() == 1);
}

TEST(FrontEndDifferences, LeaveOutWhatChangesNoFeature) {
  const AtlasContext now = MeasuredWith("{features: {parallel: false}, slam: {seed: 7}}");
  EXPECT_TRUE(FrontEndDifferences(MeasuredWith(""), now).empty());
}

TEST(FrontEndDifferences, KnowNothingOfMapsThatDoNotSay) {
  EXPECT_TRUE(FrontEndDifferences({}, MeasuredWith("features: {line_count: 100}")).empty());
}

TEST(SystemDifferences, TellWhatAPresetChanges) {
  SlamOptions options;
  OptionTable table(options);
  LoadPreset("good-line-cutting", table);
  const AtlasContext usual = MeasuredWith(""), cutting = MeasuredWith(table.Dump());
  const AtlasContext seeded = MeasuredWith("slam: {seed: 7}");
  EXPECT_EQ(
      SystemDifferences(seeded, cutting),
      (std::vector<std::string>{"lines.residual: observed_ends in the map, projected_ends now",
                                "lines.weighting: covariance in the map, none now",
                                "cutting.method: none in the map, greedy now",
                                "cutting.information: independent in the map, printed now",
                                "cutting.ends: landmark in the map, inverse_depth now",
                                "tracking.reference: local_map in the map, last_frame now"}));
  EXPECT_EQ(SystemDifferences(cutting, seeded).size(), 6U);
  EXPECT_TRUE(SystemDifferences(cutting, cutting).empty());
  EXPECT_TRUE(SystemDifferences(seeded, MeasuredWith("loop: {enabled: false}")).empty());
  EXPECT_TRUE(SystemDifferences(usual, cutting).empty()) << "a map that does not say";
}

TEST(FrontEndDifferences, TellOfOptionsThatAreNotKnown) {
  const AtlasContext later = MeasuredWith("features: {of_a_later_version: 7}");
  const std::vector<std::string> told = FrontEndDifferences(later, MeasuredWith(""));
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].find("its options:1: unknown option 'features.of_a_later_version'"), 0U);
}

}  // namespace
}  // namespace plumbline
