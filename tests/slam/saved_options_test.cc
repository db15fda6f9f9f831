// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/saved_options.h"

#include "plumbline/base/error.h"

#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(SavedOptions, AreThoseOfTheMapsOrTheDefaultOnes) {
  AtlasContext context;
  EXPECT_EQ(SavedOptions(context, "m.plb").mapping.line_map.min_keyframes,
            SlamOptions{}.mapping.line_map.min_keyframes);
  context.options_yaml = "mapping: {line_map: {min_keyframes: 7}}";
  EXPECT_EQ(SavedOptions(context, "m.plb").mapping.line_map.min_keyframes, 7);
  context.options_yaml = "mapping: {of_a_later_version: 7}";
  try {
    SavedOptions(context, "m.plb");
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

}  // namespace
}  // namespace plumbline
