// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/live/live_source.h"

#include <memory>
#include <string>
#include <vector>

namespace plumbline {

// Returns the devices of "camera:0,1" or "camera:/dev/video2": numbers, or paths as they are.
// Throws InputError unless there are one or two.
std::vector<std::string> CameraDevices(const std::string& name);

// Returns the pipeline of "gst:PIPELINE", with a sink for this program added where it has none.
std::string GstreamerPipeline(const std::string& name);

// Opens cameras (V4L2), a network stream (FFmpeg) or a GStreamer pipeline through OpenCV.
//
// Stamps count from the first frame, whose stamp is the time of the clock when it arrived. Later
// stamps follow the driver's clock for a camera; for streams and pipelines they are the times of
// arrival, as OpenCV tells no other. Two cameras are read one after the other and have the stamp of
// the first: only hardware that triggers both makes them a pair. A frame of another size counts as
// missing. A camera or a stream that is gone, or silent for ten seconds, is opened again for ten
// seconds, and has one frame missing if it comes back. Otherwise it ends, as a pipeline does at
// once.
//
// Waits for the first frame. Throws the errors of OpenLiveSource.
std::unique_ptr<LiveSource> OpenCapture(const std::string& name,
                                        LiveKind kind,
                                        const LiveOptions& options);

}  // namespace plumbline
