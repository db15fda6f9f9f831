// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/decoder_messages.h"

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <streambuf>

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

// Replaces the buffer of std::cerr. It is unbuffered: threads may write at once.
class CerrUnlessDecoding : public std::streambuf {
 public:
  explicit CerrUnlessDecoding(std::streambuf* to) : to_(to) {}

 protected:
  std::streamsize xsputn(const char* text, std::streamsize size) override {
    return open_calls > 0 ? size : to_->sputn(text, size);
  }
  int_type overflow(int_type character) override {
    const bool end = traits_type::eq_int_type(character, traits_type::eof());
    if (end || open_calls > 0) return traits_type::not_eof(character);
    return to_->sputc(traits_type::to_char_type(character));
  }
  int sync() override { return to_->pubsync(); }

 private:
  std::streambuf* to_;
};

}  // namespace

void DropDecoderMessages() {
  // NOLINTBEGIN(concurrency-mt-unsafe): there is one thread yet
  constexpr int kKeep = 0;
  ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", kKeep);  // AV_LOG_QUIET
  if (std::getenv("OPENCV_LOG_LEVEL") == nullptr) {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  }
  // NOLINTEND(concurrency-mt-unsafe)
  // It stays for ever: std::cerr is flushed when the program has ended.
  static CerrUnlessDecoding* const cerr_buffer = new CerrUnlessDecoding(std::cerr.rdbuf());
  std::cerr.rdbuf(cerr_buffer);
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
