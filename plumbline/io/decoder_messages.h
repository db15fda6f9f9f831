// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace plumbline {

// Libraries that decode images and videos write to standard error on their own ("libpng warning:
// ...", "Corrupt JPEG data", "moov atom not found"), without the name of the file and in addition
// to the program's own message.
//
// For programs, to be called before threads start. From then on, output to `stderr` and std::cerr
// during a DecoderCall of its thread is dropped, and the logs of OpenCV and FFmpeg are off unless
// the environment enables them (OPENCV_LOG_LEVEL, OPENCV_FFMPEG_LOGLEVEL). All other output, for
// example a failed assertion, is unchanged. A library must not decide this for a process, so that
// without this call nothing is dropped.
void DropDecoderMessages();

// Marks a scope in which this thread is inside a decoder.
class DecoderCall {
 public:
  DecoderCall();
  DecoderCall(const DecoderCall&) = delete;
  DecoderCall& operator=(const DecoderCall&) = delete;
  ~DecoderCall();
};

}  // namespace plumbline
