// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/paper_catalog.h"

#include "lab/experiments/catalog.h"
#include "lab/experiments/computed.h"
#include "lab/rivals/laboratory_methods.h"
#include "plumbline/base/options_io.h"
#include "plumbline/slam/options.h"
#include "plumbline/slam/options_without_effect.h"
#include "plumbline/slam/preset.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

SlamOptions OptionsOf(const std::string& experiment, const std::string& variant) {
  SlamOptions options;
  OptionTable table(options, LaboratoryMethods().added);
  for (const Variant& v : FindExperiment(experiment).variants) {
    if (v.name != variant) continue;
    const auto preset = std::find(v.arguments.begin(), v.arguments.end(), "--preset");
    if (preset != v.arguments.end()) LoadPreset(*std::next(preset), table);
    for (const std::string& setting : v.settings) table.Set(setting);
    return options;
  }
  ADD_FAILURE() << experiment << " has no " << variant;
  return options;
}

TEST(PaperCatalog, AllHoldsEveryTableAndFigure) {
  const ExperimentGroup* all = FindExperimentGroup("all");
  ASSERT_NE(all, nullptr);
  for (const std::string name : {"rippl-table1",
                                 "rippl-table2",
                                 "rippl-figure6",
                                 "rippl-figure7",
                                 "rippl-figure8",
                                 "rippl-figure9",
                                 "rippl-controls",
                                 "rippl-figure10",
                                 "rippl-figure11",
                                 "cutting-table1",
                                 "cutting-table2-3",
                                 "cutting-figure2-4",
                                 "cutting-figure5"}) {
    EXPECT_THAT(all->experiments, testing::Contains(name));
  }
  for (const char* group : {"rippl-timing", "cutting-timing"}) {
    for (const std::string& name : FindExperimentGroup(group)->experiments) {
      EXPECT_THAT(all->experiments, testing::Contains(name));
      const ComputedExperiment* computed = FindComputedExperiment(name);
      EXPECT_TRUE(computed != nullptr ? computed->exclusive : FindExperiment(name).exclusive);
    }
  }
  for (const std::string& name : all->experiments) {
    if (FindComputedExperiment(name) != nullptr) continue;
    EXPECT_NO_THROW(FindExperiment(name)) << name;
  }
}

TEST(PaperCatalog, LoopsStayOpenInAllOfThem) {
  for (const Experiment& experiment : PaperExperiments()) {
    if (experiment.command == RunCommandKind::kStarts) continue;
    for (const Variant& variant : experiment.variants) {
      EXPECT_FALSE(OptionsOf(experiment.name, variant.name).loop.enabled)
          << experiment.name << " " << variant.name;
    }
  }
}

TEST(PaperCatalog, TheSystemsOfTable2DifferInAllThatMakesThem) {
  const SlamOptions rippl = OptionsOf("rippl-table2", "RIPPL"),
                    epl = OptionsOf("rippl-table2", "EPL"), ppl = OptionsOf("rippl-table2", "PPL");
  EXPECT_EQ(rippl.initialization.method, "rank1_pairwise");
  EXPECT_EQ(epl.initialization.method, "two_view");
  EXPECT_EQ(ppl.initialization.method, "two_view");
  EXPECT_EQ(rippl.lines.residual, "observed_ends");
  EXPECT_EQ(epl.lines.residual, "projected_endpoints");
  EXPECT_EQ(epl.lines.reconstruction, "two_view");
  EXPECT_EQ(ppl.lines.residual, "plucker_left");
  EXPECT_EQ(ppl.lines.reconstruction, "two_view");
  for (const SlamOptions* options : {&rippl, &epl, &ppl}) {
    EXPECT_EQ(options->features.point_count, 500);
    EXPECT_EQ(options->features.line_count, 300);
    EXPECT_FALSE(options->mapping.window.parallel_lines);
    EXPECT_EQ(options->lines.weighting, rippl.lines.weighting);
  }
}

TEST(PaperCatalog, TheControlsOfTable2TakeOneStepEach) {
  const Experiment& experiment = FindExperiment("rippl-table2-controls");
  const auto differences = [&](const Variant& variant) {
    const std::string& reference =
        variant.reference.empty() ? experiment.reference : variant.reference;
    return DifferentOptions(OptionsOf(experiment.name, variant.name),
                            OptionsOf(experiment.name, reference));
  };
  const std::vector<Variant>& variants = experiment.variants;
  ASSERT_EQ(variants.size(), 4U);
  EXPECT_THAT(differences(variants[0]), testing::IsEmpty());
  EXPECT_THAT(differences(variants[1]), testing::ElementsAre("initialization.method"));
  EXPECT_THAT(differences(variants[2]), testing::ElementsAre("lines.reconstruction"));
  EXPECT_THAT(differences(variants[3]), testing::ElementsAre("lines.residual"));
  for (const char* name : {"RIPPL", "PPL"}) {
    EXPECT_THAT(DifferentOptions(OptionsOf(experiment.name, name), OptionsOf("rippl-table2", name)),
                testing::IsEmpty());
  }
}

TEST(PaperCatalog, TrimmedLinesDifferFromWholeAndCutOnesInTheMethodAlone) {
  for (const char* experiment : {"cutting-table1", "cutting-table2-3"}) {
    for (const std::string lines : {"L", "PL"}) {
      const SlamOptions trimmed = OptionsOf(experiment, lines + "_trimmed");
      EXPECT_EQ(trimmed.cutting.method, "trim");
      for (const std::string& other : {lines, lines + "+Cut"}) {
        EXPECT_THAT(DifferentOptions(trimmed, OptionsOf(experiment, other)),
                    testing::ElementsAre("cutting.method"));
      }
    }
  }
}

// But for controls of starts, which differ in one option from what they are compared with.
TEST(PaperCatalog, NoSystemSetsAnOptionWithoutEffect) {
  for (const Experiment& experiment : PaperExperiments()) {
    if (experiment.command == RunCommandKind::kStarts) continue;
    for (const Variant& variant : experiment.variants) {
      std::vector<std::string> set;
      for (const std::string& setting : variant.settings) {
        set.push_back(setting.substr(0, setting.find('=')));
      }
      const SlamOptions options = OptionsOf(experiment.name, variant.name);
      EXPECT_THAT(OptionsWithoutEffect(options, set), testing::IsEmpty())
          << experiment.name << " " << variant.name;
    }
  }
}

TEST(PaperCatalog, TheDefaultSystemStandsBesideThoseOfThePapers) {
  SlamOptions usual;
  usual.loop.enabled = false;
  for (const char* experiment : {"rippl-table2", "cutting-table1", "cutting-table2-3"}) {
    SlamOptions beside = OptionsOf(experiment, "default");
    EXPECT_EQ(OptionTable(beside).Dump(), OptionTable(usual).Dump()) << experiment;
  }
}

TEST(PaperCatalog, NoSystemOfAPaperAdjustsTheWholeMap) {
  for (const Experiment& experiment : PaperExperiments()) {
    if (experiment.command == RunCommandKind::kStarts) continue;
    for (const Variant& variant : experiment.variants) {
      if (variant.name == "default") continue;
      EXPECT_EQ(OptionsOf(experiment.name, variant.name).mapping.final_adjustment_keyframes, 0)
          << experiment.name << " " << variant.name;
    }
  }
}

TEST(PaperCatalog, ControlsAreTheExperimentsThatTheResultsAreOf) {
  const ExperimentGroup* controls = FindExperimentGroup("controls");
  ASSERT_NE(controls, nullptr);
  for (const std::string& name : controls->experiments) {
    const Experiment& experiment = FindExperiment(name);
    EXPECT_FALSE(experiment.reference.empty()) << name;
    EXPECT_FALSE(experiment.exclusive) << name;
  }
}

TEST(PaperCatalog, TheLinesOfFigures10And11AreThoseOfOneCamera) {
  for (const char* name : {"rippl-figure10", "rippl-figure11"}) {
    const Experiment& experiment = FindExperiment(name);
    const auto& table2 = FindExperiment("rippl-table2").variants;
    ASSERT_EQ(experiment.variants.size(), table2.size());
    for (std::size_t v = 0; v < table2.size(); ++v) {
      EXPECT_EQ(experiment.variants[v].name, table2[v].name);
      EXPECT_EQ(experiment.variants[v].settings, table2[v].settings);
    }
    EXPECT_EQ(experiment.variants.back().arguments, (std::vector<std::string>{"--sensor", "mono"}));
    EXPECT_THAT(experiment.metrics, testing::Contains("map_line_error"));
  }
}

TEST(PaperCatalog, CuttingIsAgainstTheLastFrameWithoutWeights) {
  for (const std::string name : {"L", "L+Cut", "PL", "PL+Cut", "P"}) {
    const SlamOptions options = OptionsOf("cutting-table2-3", name);
    EXPECT_EQ(options.tracking.reference, TrackingReference::kLastFrame) << name;
    EXPECT_EQ(options.lines.weighting, LineWeighting::kNone) << name;
    if (options.features.lines) {
      EXPECT_EQ(options.cutting.method == "greedy", name.ends_with("Cut")) << name;
    }
    EXPECT_EQ(options.features.points, name.starts_with("P")) << name;
    EXPECT_EQ(options.features.lines, name != "P") << name;
  }
}

TEST(PaperCatalog, EverySequenceOfAPaperTellsWhereItComesFrom) {
  std::set<std::string> tum, euroc;
  for (const Experiment& experiment : PaperExperiments()) {
    for (const SequenceChoice& choice : experiment.sequences) {
      if (choice.paper.empty() || choice.pattern.starts_with("worlds/")) continue;
      EXPECT_TRUE(choice.source.starts_with("https://")) << choice.pattern;
      (choice.pattern.starts_with("tum/") ? tum : euroc).insert(choice.pattern);
    }
  }
  EXPECT_EQ(tum.size(), 8U);
  EXPECT_EQ(euroc.size(), 6U);
}

TEST(PaperCatalog, EightWorldsStandIn) {
  std::set<std::string> worlds;
  for (const Experiment& experiment : PaperExperiments()) {
    for (const SequenceChoice& choice : experiment.sequences) {
      if (choice.pattern.starts_with("worlds/")) worlds.insert(choice.pattern);
    }
  }
  worlds.erase("worlds/vicon_*");
  EXPECT_GE(worlds.size(), 8U);
}

}  // namespace
}  // namespace plumbline
