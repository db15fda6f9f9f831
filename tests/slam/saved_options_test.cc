// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/saved_options.h"

#include "plumbline/base/error.h"

#include <string>

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

}  // namespace
}  // namespace plumbline
