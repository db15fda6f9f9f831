// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/user_options.h"

#include "plumbline/base/options_io.h"
#include "plumbline/slam/options.h"

#include <algorithm>
#include <cstddef>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(UserOptions, AreFewAndExist) {
  SlamOptions options;
  const auto keys = OptionTable(options).Keys();
  const auto users = std::count_if(
      keys.begin(), keys.end(), [](const std::string& key) { return IsUserOption(key); });
  EXPECT_EQ(users, 31);  // all that are named; at most 35 may be
  EXPECT_FALSE(IsUserOption("mapping.ba.rounds"));
  EXPECT_FALSE(IsUserOption("lines.parametrization"));  // one value without the laboratory
  EXPECT_FALSE(IsUserOption("slam"));
}

}  // namespace
}  // namespace plumbline
