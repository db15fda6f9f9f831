// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Part of libplumbline_opencv.so, as video_decoder_library.cc is.
#pragma once

#include <memory>
#include <string>

namespace plumbline {

class VideoDecoder;  // opencv_modules.h

// Opens a video file. Returns nullptr if FFmpeg does not recognize it.
std::unique_ptr<VideoDecoder> OpenVideoDecoder(const std::string& path);

}  // namespace plumbline
