// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/live/live_source.h"

#include <memory>
#include <string>

namespace plumbline {

// Opens a source and waits for its first frame or header:
//   -                standard input (raw_stream.h)
//   camera:0         a camera by number, "camera:0,1" two of them as a stereo pair, or by its
//                    device: "camera:/dev/video2" (capture_source.h)
//   rtsp://...       a network stream, also rtsps://
//   gst:PIPELINE     the output of a GStreamer pipeline
// Throws InputError if the source does not exist, if no camera file is given, or if images have
// another size than calibrated.
std::unique_ptr<LiveSource> OpenLiveSource(const std::string& name, const LiveOptions& options);

}  // namespace plumbline
