// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/log.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(Log, IsSilentBelowWarningByDefault) {
  testing::internal::CaptureStderr();
  Log(LogLevel::kInfo, "not {}", "seen");
  Log(LogLevel::kWarning, "seen {}", 7);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "plumbline: warning: seen 7\n");
}

TEST(Log, LevelCanBeChanged) {
  SetLogLevel(LogLevel::kTrace);
  EXPECT_TRUE(LogEnabled(LogLevel::kTrace));
  SetLogLevel(LogLevel::kOff);
  EXPECT_FALSE(LogEnabled(LogLevel::kWarning));
  EXPECT_FALSE(LogEnabled(LogLevel::kOff));
  SetLogLevel(LogLevel::kWarning);
  EXPECT_TRUE(LogEnabled(LogLevel::kWarning));
  EXPECT_FALSE(LogEnabled(LogLevel::kInfo));
}

}  // namespace
}  // namespace plumbline
