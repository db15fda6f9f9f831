// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/rippl_controls.h"

#include "lab/rivals/laboratory_methods.h"
#include "plumbline/base/options_io.h"
#include "plumbline/slam/options.h"
#include "plumbline/slam/preset.h"

#include <map>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace rippl_controls_test {

using testing::ElementsAre;
using testing::IsEmpty;

// All options of a run by key.
std::map<std::string, std::string> OptionsOf(const Variant& variant) {
  EXPECT_THAT(variant.arguments, ElementsAre("--preset", "rippl"));
  SlamOptions options;
  OptionTable table(options, LaboratoryMethods().added);
  LoadPreset("rippl", table);
  for (const std::string& setting : variant.settings) table.Set(setting);
  std::map<std::string, std::string> values;
  for (const std::string& key : table.Keys()) values[key] = table.Value(key);
  return values;
}

const Variant& Find(const Experiment& experiment, const std::string& name) {
  for (const Variant& variant : experiment.variants) {
    if (variant.name == name) return variant;
  }
  ADD_FAILURE() << "no variant " << name;
  return experiment.variants.front();
}

// "KEY=VALUE" of what a variant has other than the one that it is compared with.
std::vector<std::string> Differences(const Experiment& experiment, const std::string& name) {
  const Variant& variant = Find(experiment, name);
  const std::string& own = variant.reference;
  const auto reference = OptionsOf(Find(experiment, own.empty() ? experiment.reference : own));
  std::vector<std::string> differences;
  for (const auto& [key, value] : OptionsOf(variant)) {
    if (reference.at(key) != value) differences.push_back(key + "=" + value);
  }
  return differences;
}

TEST(RipplControls, DifferInOneThingFromWhatTheyAreComparedWith) {
  const Experiment experiment = RipplControls();
  EXPECT_THAT(Differences(experiment, "proposed"), IsEmpty());
  std::set<std::string> varied;
  for (const Variant& variant : experiment.variants) {
    if (variant.name == "proposed") continue;
    const auto differences = Differences(experiment, variant.name);
    ASSERT_EQ(differences.size(), 1U) << variant.name;
    varied.insert(differences.front());
  }
  EXPECT_THAT(varied,
              ElementsAre("features.point_count=500",
                          "initialization.factorize=false",
                          "initialization.frames=10",
                          "initialization.frames=5",
                          "initialization.method=two_view",
                          "initialization.pairwise.adjust=false",
                          "initialization.pairwise.missing=leave_out",
                          "initialization.pairwise.missing=triangulate",
                          "initialization.pairwise.reject_outliers=false",
                          "initialization.reweighting=0"));
}

// Chained lengths need no complete tracks: nothing is interpolated on either side.
TEST(RipplControls, FactorizationIsJudgedWithoutInterpolation) {
  const Experiment experiment = RipplControls();
  for (const std::string end : {"", "_as_found"}) {
    EXPECT_EQ(Find(experiment, "no_factorization" + end).reference, "triangulated" + end);
    EXPECT_EQ(Find(experiment, "triangulated" + end).reference, "proposed" + end);
  }
}

TEST(RipplControls, AreOfThePapersStart) {
  const auto options = OptionsOf(RipplControls().variants.front());
  EXPECT_EQ(options.at("initialization.method"), "rank1_pairwise");
  EXPECT_EQ(options.at("initialization.frames"), "3");
  EXPECT_EQ(options.at("features.point_count"), "2000");
}

}  // namespace rippl_controls_test
}  // namespace plumbline
