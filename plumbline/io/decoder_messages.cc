// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/decoder_messages.h"

#include <cstddef>
#include <cstdio>
#include <cstdlib>

#include <opencv2/core/utils/logger.hpp>
#include <unistd.h>

namespace plumbline {
namespace {

thread_local int open_calls = 0;

#ifdef __GLIBC__
ssize_t WriteUnlessDecoding(void*, const char* text, std::size_t size) {
  return open_calls > 0 ? static_cast<ssize_t>(size) : ::write(STDERR_FILENO, text, size);
}
#endif

}  // namespace

void DropDecoderMessages() {
  // NOLINTBEGIN(concurrency-mt-unsafe): there is one thread yet
  constexpr int kKeep = 0;
  ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", kKeep);  // AV_LOG_QUIET
  if (std::getenv("OPENCV_LOG_LEVEL") == nullptr) {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  }
  // NOLINTEND(concurrency-mt-unsafe)
#ifdef __GLIBC__
  // `stderr` is a variable in the GNU C library; std::cerr keeps the stream it has.
  std::FILE* const stream =
      ::fopencookie(nullptr, "w", {nullptr, WriteUnlessDecoding, nullptr, nullptr});
  if (stream == nullptr) return;
  std::setvbuf(stream, nullptr, _IONBF, 0);
  stderr = stream;
#endif
}

DecoderCall::DecoderCall() { ++open_calls; }
DecoderCall::~DecoderCall() { --open_calls; }

}  // namespace plumbline
