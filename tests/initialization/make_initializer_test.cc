// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/make_initializer.h"

#include "plumbline/base/error.h"
#include "plumbline/initialization/pairwise_initializer.h"
#include "plumbline/initialization/rank1_initializer.h"

#include "tests/support/synthetic_world.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(MakeInitializer, MakesTheMethodNamed) {
  const auto make = [&](const std::string& method) {
    return MakeInitializer({TestCamera(), 1.2}, {.method = method}, 1);
  };
  EXPECT_TRUE(dynamic_cast<Rank1Initializer*>(make("rank1").get()));
  EXPECT_TRUE(dynamic_cast<PairwiseInitializer*>(make("rank1_pairwise").get()));
  EXPECT_THROW(make("two_view"), BugError);
}

}  // namespace
}  // namespace plumbline
