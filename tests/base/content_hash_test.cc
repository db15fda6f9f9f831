// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/content_hash.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(ContentHash, TellsContentsAndSeedsApart) {
  EXPECT_EQ(ContentHash("abc"), ContentHash("abc"));
  std::set<std::uint64_t> seen;
  for (int i = 0; i < 1000; ++i) {
    for (std::uint64_t seed = 0; seed < 2; ++seed) {
      EXPECT_TRUE(seen.insert(ContentHash("text " + std::to_string(i), seed)).second);
    }
  }
}

}  // namespace
}  // namespace plumbline
