// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/user_options.h"

#include "plumbline/base/options_io.h"
#include "plumbline/slam/options.h"
#include "plumbline/slam/preset.h"

#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

// All that are named exist: a key that is wrong would be of no tier. What is allowed is in
// tools/check_options.py.
TEST(OptionTiers, AreFewAndExist) {
  SlamOptions options;
  std::map<OptionTier, int> count;
  for (const std::string& key : OptionTable(options).Keys()) ++count[TierOf(key)];
  EXPECT_EQ(count[OptionTier::kUser], 26);
  EXPECT_EQ(count[OptionTier::kPaper], 25);
  EXPECT_EQ(count[OptionTier::kMethod], 12);
  EXPECT_EQ(TierOf("features.orb.calibration_sigma"), OptionTier::kMethod);
  EXPECT_EQ(TierOf("lines.residual"), OptionTier::kPaper);
  EXPECT_EQ(TierOf("slam.lag"), OptionTier::kUser);
}

// Whatever a preset changes is an option of users or of the papers.
TEST(OptionTiers, OfPresetsAreThoseOfUsersAndPapers) {
  for (const char* preset : {"rippl", "good-line-cutting"}) {
    SlamOptions options, unchanged;
    OptionTable table(options);
    const OptionTable defaults(unchanged);
    LoadPreset(preset, table);
    for (const OptionField& field : table.fields()) {
      if (OptionTable::ValueOf(field) == defaults.Value(field.key)) continue;
      EXPECT_NE(TierOf(field.key), OptionTier::kMethod) << field.key;
    }
  }
}

TEST(ListOptions, HasThoseOfThePapersUnderAHeadingAndIsAFileOfAllOptions) {
  SlamOptions options;
  OptionTable table(options);
  LoadPreset("rippl", table);
  table.Set("slam.lag=3");
  const std::string list = ListOptions(table);
  const auto heading = list.find("\n# Of the papers' presets: ");
  ASSERT_NE(heading, std::string::npos);
  EXPECT_LT(list.find("  lag: 3 "), heading);
  EXPECT_GT(list.find("\nlines.rotation_gate: true "), heading);
  EXPECT_THAT(list, ::testing::Not(::testing::HasSubstr("\nlines:")));
  SlamOptions again;
  OptionTable read(again);
  read.LoadText(list, "list");
  EXPECT_EQ(read.Dump(), table.Dump());
}

}  // namespace
}  // namespace plumbline
