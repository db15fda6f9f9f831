// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/catalog.h"

#include "lab/experiments/metrics.h"
#include "lab/rivals/laboratory_methods.h"
#include "lab/starts/start_bench.h"
#include "plumbline/base/options_io.h"
#include "plumbline/slam/options.h"
#include "worlds/synth_options.h"

#include "tests/io/scratch_folder.h"
#include <map>
#include <regex>
#include <set>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

TEST(Catalog, EveryEntryNamesOnlyWhatThereIs) {
  std::set<std::string> names;
  for (const Experiment& experiment : Experiments()) {
    EXPECT_TRUE(names.insert(experiment.name).second) << experiment.name;
    EXPECT_FALSE(experiment.help.empty()) << experiment.name;
    EXPECT_FALSE(experiment.sequences.empty()) << experiment.name;
    EXPECT_GE(experiment.runs, 1) << experiment.name;
    for (const auto* metrics : {&experiment.metrics, &experiment.plots}) {
      for (const std::string& metric : *metrics) EXPECT_NE(FindMetric(metric), nullptr) << metric;
    }
    std::set<std::string> variants;
    for (const Variant& variant : experiment.variants) {
      EXPECT_TRUE(variants.insert(variant.name).second) << variant.name;
      EXPECT_TRUE(std::regex_match(variant.name, std::regex("[A-Za-z0-9_+-]+"))) << variant.name;
      SlamOptions of_run;
      StartOptions of_starts;
      const auto& added = LaboratoryMethods().added;
      OptionTable table = experiment.command == RunCommandKind::kStarts
                              ? OptionTable(of_starts, added)
                              : OptionTable(of_run, added);
      for (const std::string& setting : variant.settings) {
        EXPECT_EQ(MessageOf([&] { table.Set(setting); }), "no error");
      }
      EXPECT_EQ(variant.curve.empty(), experiment.abscissa.empty()) << variant.name;
    }
    for (const Variant& variant : experiment.variants) {
      EXPECT_TRUE(variant.reference.empty() || variants.contains(variant.reference))
          << variant.name;
    }
    EXPECT_TRUE(experiment.reference.empty() || variants.contains(experiment.reference))
        << experiment.name;
    for (const SequenceChoice& choice : experiment.sequences) {
      EXPECT_NE(choice.pattern.find('/'), std::string::npos) << choice.pattern;
      SynthOptions options;
      for (const std::string& setting : choice.world_settings) {
        EXPECT_EQ(MessageOf([&] { OptionTable(options).Set(setting); }), "no error");
      }
      EXPECT_TRUE(choice.world_settings.empty() || !choice.label.empty()) << choice.pattern;
    }
  }
}

TEST(Catalog, FindsByNameAndTellsWhatThereIs) {
  EXPECT_EQ(FindExperiment("sensors").variants.size(), 3U);
  EXPECT_THAT(MessageOf([] { FindExperiment("sensor"); }),
              HasSubstr("no experiment 'sensor'; there are: sensors"));
}

// Not all kinds can be held parallel to others, so that none is where kinds are compared.
TEST(Catalog, KindsOfLinesDifferInNothingElse) {
  for (const char* name : {"lines", "lines_mono", "line_controls", "line_controls_mono"}) {
    for (const Variant& variant : FindExperiment(name).variants) {
      EXPECT_THAT(variant.settings, Contains("mapping.window.parallel_lines=false"))
          << name << " " << variant.name;
    }
  }
}

TEST(Catalog, CuttingHasEverySettingOfThePaperTwiceSharpAndBlurred) {
  std::map<std::string, const Variant*> variants;
  for (const Variant& variant : FindExperiment("cutting").variants)
    variants[variant.name] = &variant;
  EXPECT_EQ(variants.size(), 60U);
  for (const std::string reference : {"last", "map"}) {
    for (const std::string end : {"", "_blur"}) {
      EXPECT_TRUE(variants.contains(reference + "_P" + end));
      EXPECT_TRUE(variants.contains(reference + "_PL_covariance" + end));
      EXPECT_TRUE(variants.contains(reference + "_PL80_covariance" + end));
      for (const std::string kind : {"L", "L+Cut", "PL", "PL+Cut", "PL80", "PL80+Cut"}) {
        for (const std::string weighting : {"none", "scalar"}) {
          const std::string name = reference + "_" + kind + "_" + weighting + end;
          ASSERT_TRUE(variants.contains(name)) << name;
          SlamOptions options;
          OptionTable table(options, LaboratoryMethods().added);
          for (const std::string& setting : variants[name]->settings) table.Set(setting);
          EXPECT_EQ(options.tracking.reference == TrackingReference::kLastFrame,
                    reference == "last");
          const std::string cutting = kind.starts_with("PL80") ? "best_80"
                                      : kind.ends_with("Cut")  ? "greedy"
                                                               : "none";
          EXPECT_EQ(options.cutting.method,
                    kind == "PL80+Cut" ? std::string("best_80_greedy") : cutting);
          EXPECT_EQ(options.features.points, kind.starts_with("P"));
          EXPECT_EQ(NameOf(options.lines.weighting), weighting);
          EXPECT_EQ(variants[name]->arguments.empty(), end.empty());
        }
      }
    }
  }
}

TEST(Catalog, RobustnessComparesEveryWayToPlayARecordingWithTheRecordingItself) {
  for (const std::string name : {"robustness", "robustness_mono"}) {
    const Experiment& experiment = FindExperiment(name);
    EXPECT_EQ(experiment.reference, "as_recorded");
    std::map<std::string, std::string> arguments;
    for (const Variant& variant : experiment.variants) {
      EXPECT_TRUE(variant.settings.empty()) << "the defaults are to hold: " << variant.name;
      arguments[variant.name] = fmt::format("{}", fmt::join(variant.arguments, " "));
    }
    const std::string mono = name == "robustness" ? "" : "--sensor mono";
    const std::string end = mono.empty() ? "" : " " + mono;
    EXPECT_THAT(arguments,
                ElementsAre(Pair("as_recorded", mono),
                            Pair("blurred", "--blur 5" + end),
                            Pair("every_2nd", "--stride 2" + end),
                            Pair("every_3rd", "--stride 3" + end),
                            Pair("every_4th", "--stride 4" + end),
                            Pair("every_5th", "--stride 5" + end),
                            Pair("reversed", mono)));
    for (const SequenceChoice& choice : experiment.sequences) {
      EXPECT_FALSE(choice.pattern.starts_with("worlds/")) << "recorded only: " << choice.pattern;
    }
  }
}

}  // namespace
}  // namespace plumbline
