// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/live/live_source.h"

#include <memory>
#include <string>

namespace plumbline {

// Opens cameras (V4L2), a network stream (FFmpeg) or a GStreamer pipeline through OpenCV.
//
// Cameras are asked for images of the size that the calibration has, of twice the width where one
// device has the images of both. Streams and pipelines have the size they have.
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
