// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/line_method.h"

#include "plumbline/base/error.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(ChooseLineMethod, DoesOtherKindsOfLinesInBuildsWithTheLaboratory) {
  SlamOptions options;
  options.lines.residual = LineResidualKind::kProjectedEnds;
  EXPECT_THROW(CheckOptions(options), InputError);
  ChooseLineMethod(options);
#ifdef PLUMBLINE_WITH_LAB
  EXPECT_NO_THROW(CheckOptions(options));
#else
  EXPECT_THROW(CheckOptions(options), InputError);
#endif
}

}  // namespace
}  // namespace plumbline
