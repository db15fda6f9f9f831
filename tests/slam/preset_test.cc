// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/preset.h"

#include "plumbline/base/error.h"
#include "plumbline/slam/options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(Presets, SetOptionsThatExistAndAgree) {
  for (const Preset& preset : Presets()) {
    SlamOptions options;
    OptionTable table(options);
    LoadPreset(preset.name, table);
    CheckOptions(options);
    SlamOptions defaults;
    EXPECT_NE(table.Dump(), OptionTable(defaults).Dump()) << preset.name;
  }
}

TEST(Presets, LeaveOtherOptionsAsTheyAreAndGiveWayToLaterOnes) {
  SlamOptions options;
  OptionTable table(options);
  table.Set("slam.seed=7");
  EXPECT_FALSE(LoadPreset("rippl", table).needs_stereo);
  EXPECT_EQ(options.slam.seed, 7);
  EXPECT_FALSE(options.loop.enabled);
  table.Set("loop.enabled=true");
  EXPECT_TRUE(options.loop.enabled);
  EXPECT_TRUE(LoadPreset("good-line-cutting", table).needs_stereo);
}

TEST(Presets, AreNamedWhereOneIsUnknown) {
  try {
    FindPreset("ripple");
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "preset: expected good-line-cutting or rippl, found 'ripple'");
  }
}

}  // namespace
}  // namespace plumbline
