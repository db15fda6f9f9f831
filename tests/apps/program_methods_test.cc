// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/program_methods.h"

#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(ProgramMethods, AreThoseOfTheLaboratoryInBuildsThatHaveIt) {
  SlamOptions options;
  OptionTable table(options, ProgramMethods().added);
#ifdef PLUMBLINE_WITH_LAB
  table.Set("lines.residual=endpoints");
  EXPECT_NO_THROW(CheckOptions(options, ProgramMethods()));
#else
  EXPECT_THROW(table.Set("lines.residual=endpoints"), InputError);
#endif
  options.lines.residual = "no method at all";
  EXPECT_THROW(CheckOptions(options, ProgramMethods()), InputError);
}

}  // namespace
}  // namespace plumbline
