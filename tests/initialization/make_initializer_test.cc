// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/make_initializer.h"

#include "plumbline/initialization/klt_initializer.h"
#include "plumbline/initialization/rank1_initializer.h"
#include "plumbline/initialization/two_view.h"

#include "tests/support/synthetic_world.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(MakeInitializer, MakesTheMethodNamed) {
  const auto make = [&](InitializationMethod method) {
    return MakeInitializer({TestCamera(), 1.2}, {.method = method}, 1);
  };
  using enum InitializationMethod;
  EXPECT_TRUE(dynamic_cast<Rank1Initializer*>(make(kRank1).get()));
  EXPECT_TRUE(dynamic_cast<KltInitializer*>(make(kRank1Klt).get()));
  EXPECT_TRUE(dynamic_cast<TwoViewInitializer*>(make(kTwoView).get()));
  EXPECT_TRUE(dynamic_cast<TwoViewImagesInitializer*>(make(kTwoViewImages).get()));
}

}  // namespace
}  // namespace plumbline
