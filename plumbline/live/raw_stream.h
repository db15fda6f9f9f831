// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/live/live_source.h"

#include <memory>

namespace plumbline {

// Frames from another program through a pipe. Lines of text (ASCII, ended by \n) announce the
// content, pixels follow as bytes:
//
//   plumbline frames 1
//   left mono8 752 480
//   right mono8 752 480             only of a pair
//   depth 16UC1 752 480 1000        only of RGB-D; the last number: value per metre (default: the
//   end                             camera file's, or 1000)
//   frame 1403636579763555584       stamp in nanoseconds
//   <752*480 bytes of left><752*480 bytes of right>...
//   frame 1403636579813555456
//   ...
//   missing 1403636592913555456     a frame that the sender could not get
//
// Encodings and their bytes: raw_pixels.h, 16 and 32 bits little-endian. Rows have no padding.
// Images come in the order of the header. The end of the stream is the end of the run; an end
// within a frame loses that frame only.
//
// Reads the header from the file descriptor, which stays open. Data in another format throw an
// InputError that begins with "standard input:": a wrong header at once, a wrong frame in Next.
std::unique_ptr<LiveSource> OpenRawStream(int descriptor, const LiveOptions& options);

}  // namespace plumbline
