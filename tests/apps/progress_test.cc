// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/progress.h"

#include <chrono>
#include <iostream>
#include <sstream>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace progress_test {

using testing::HasSubstr;
using testing::IsEmpty;

// What is written to std::clog meanwhile.
class CapturedLog {
 public:
  CapturedLog() : before_(std::clog.rdbuf(text_.rdbuf())) {}
  ~CapturedLog() { std::clog.rdbuf(before_); }
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::streambuf* before_;
};

TEST(AdjustmentProgress, TellsForHowLongMapsHaveBeenAdjusted) {
  const CapturedLog log;
  AdjustmentProgress progress{ProgressLine(false, std::chrono::milliseconds(0))};
  progress.Show();
  EXPECT_THAT(log.text(), IsEmpty());
  std::this_thread::sleep_for(std::chrono::milliseconds(150));
  progress.Show();
  EXPECT_THAT(log.text(), HasSubstr("adjusting the map  0 s"));
}

TEST(AdjustmentProgress, SaysNothingWhenQuiet) {
  const CapturedLog log;
  {
    AdjustmentProgress progress{ProgressLine(true, std::chrono::milliseconds(0))};
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    progress.Show();
  }
  EXPECT_THAT(log.text(), IsEmpty());
}

}  // namespace progress_test
}  // namespace plumbline
