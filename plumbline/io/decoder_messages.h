// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace plumbline {

// Libraries that decode images and videos write to standard error on their own ("libpng warning:
// ...", "Corrupt JPEG data", "moov atom not found"), without the name of the file and beside the
// message of the program, which says what matters.
//
// For programs, to be called before there are threads. From then on, what is written to `stderr`
// and std::cerr while a DecoderCall of its thread lives is dropped, and the logs of OpenCV and
// FFmpeg are off unless the environment asks for them (OPENCV_LOG_LEVEL, OPENCV_FFMPEG_LOGLEVEL).
// Everything else that is written there, such as a failed assertion, goes where it went before. A
// library must not decide this for a process, so that without this call nothing is dropped.
void DropDecoderMessages();

// While it lives, this thread is inside a decoder.
class DecoderCall {
 public:
  DecoderCall();
  DecoderCall(const DecoderCall&) = delete;
  DecoderCall& operator=(const DecoderCall&) = delete;
  ~DecoderCall();
};

}  // namespace plumbline
