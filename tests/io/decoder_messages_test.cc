// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/decoder_messages.h"

#include "plumbline/io/image_file.h"

#include "tests/io/scratch_folder.h"
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
    std::cerr << "within " << 'c' << 1 << std::endl;
    std::thread([] {
      std::fputs("beside ", stderr);
      std::cerr << "it " << 'c' << 1 << ' ';
    }).join();
  }
  std::fputs("after", stderr);
  std::cerr << " it";
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "before beside it c1 after it");
}

// OpenCV says on std::cerr that an image ends early.
TEST(DropDecoderMessages, DropsWhatOpenCvSaysOfAnImage) {
  const ScratchFolder folder;
  DropDecoderMessages();
  testing::internal::CaptureStderr();
  EXPECT_FALSE(ReadGrayImage(folder.Write("a.pgm", "P5\n64 48\n255\nfew")));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace plumbline
