// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/live/live_source.h"

#include <memory>
#include <string>
#include <vector>

namespace plumbline {

// The devices of "camera:0,1" or "camera:/dev/video2": numbers, or paths as they are. InputError
// unless there are one or two.
std::vector<std::string> CameraDevices(const std::string& name);

// The pipeline of "gst:PIPELINE", with a sink that this program reads from where it has none.
std::string GstreamerPipeline(const std::string& name);

// Opens cameras (V4L2), a network stream (FFmpeg) or a GStreamer pipeline through OpenCV.
//
// Stamps count from the first frame, which has the time of the clock when it arrived: of a camera
// by its driver's clock, of streams and pipelines by when frames arrive here, as OpenCV tells no
// other time of them. Two cameras are read one after the other and have the stamp of the first:
// only hardware that triggers both makes them a pair. A frame of another size is missing. A camera
// or a stream that is gone, or says nothing for ten seconds, is opened again for ten seconds, and
// has one frame missing if it comes back; otherwise it ends, as a pipeline does at once.
//
// Waits for the first frame. Errors as of OpenLiveSource.
std::unique_ptr<LiveSource> OpenCapture(const std::string& name,
                                        LiveKind kind,
                                        const LiveOptions& options);

}  // namespace plumbline
