// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/process_settings.h"

#include <csignal>

#include <gtest/gtest.h>
#include <opencv2/core/utility.hpp>

namespace plumbline {
namespace {

TEST(ProcessSettings, LeaveThreadsToTheLibraryAndLetLargeFilesFail) {
  cv::setNumThreads(4);
  std::signal(SIGXFSZ, SIG_DFL);
  SetUpProcess();
  EXPECT_EQ(cv::getNumThreads(), 1);
  EXPECT_EQ(std::signal(SIGXFSZ, SIG_DFL), SIG_IGN);
}

}  // namespace
}  // namespace plumbline
