// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/live/live_source.h"

#include <memory>
#include <string>

namespace plumbline {

// Opens cameras (V4L2), a network stream (FFmpeg) or a GStreamer pipeline through OpenCV.
//
// Cameras are opened with the calibrated image size, twice as wide if one device has the images of
// both. Streams and pipelines keep their size.
//
// Stamps count from the first frame, whose stamp is the time of the clock at its arrival. Later
// stamps follow the driver's clock for a camera; for streams and pipelines they are the times of
// arrival, since OpenCV reports no others. Two cameras are read one after the other and have the
// stamp of the first: only a hardware trigger makes them a synchronized pair. A frame of another
// size counts as missing. A camera or a stream that disconnects, or is silent for ten seconds, is
// reopened for ten seconds, and has one frame missing if it comes back. Otherwise it ends, as a
// pipeline does at once.
//
// Waits for the first frame. Throws the errors of OpenLiveSource.
std::unique_ptr<LiveSource> OpenCapture(const std::string& name,
                                        LiveKind kind,
                                        const LiveOptions& options);

}  // namespace plumbline
