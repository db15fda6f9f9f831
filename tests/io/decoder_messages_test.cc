// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/decoder_messages.h"

#include <cstdio>
#include <iostream>
#include <thread>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(DropDecoderMessages, DropsWhatIsSaidWithinADecoderAlone) {
  DropDecoderMessages();
  testing::internal::CaptureStderr();
  std::fputs("before ", stderr);
  {
    const DecoderCall call;
    std::fputs("within ", stderr);
    {
      const DecoderCall inner;
      std::fprintf(stderr, "%s ", "deeper");
    }
    std::fputs("within ", stderr);
    std::cerr << "ours ";
    std::thread([] { std::fputs("beside ", stderr); }).join();
  }
  std::fputs("after", stderr);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "before ours beside after");
}

}  // namespace
}  // namespace plumbline
