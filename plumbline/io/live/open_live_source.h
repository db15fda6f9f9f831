// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/camera.h"
#include "plumbline/io/datasets/image_file.h"
#include "plumbline/io/live/live_source.h"

#include <memory>
#include <string>
#include <vector>

namespace plumbline {

// Opens a source and waits for its first frame or header:
//   -                standard input (OpenRawStream)
//   camera:0         a camera by number, "camera:0,1" two of them as a stereo pair, or by its
//                    device: "camera:/dev/video2" (OpenCapture)
//   rtsp://...       a network stream, also rtsps://
//   gst:PIPELINE     the output of a GStreamer pipeline
// Throws InputError if the source does not exist, if no camera file is given, or if images have
// another size than calibrated.
std::unique_ptr<LiveSource> OpenLiveSource(const std::string& name, const LiveOptions& options);

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

// Frames from another program through a pipe. Lines of text (ASCII, ended by \n) announce the
// content, pixels follow as bytes:
//
//   plumbline frames 1
//   left mono8 752 480
//   right mono8 752 480             only of a pair
//   depth 16UC1 752 480 1000        only of RGB-D; the last number: value per metre (default: that
//                                   of the camera file, or 1000)
//   imu                             only with an inertial sensor
//   end
//   imu 1403636579758555392 -0.099 0.147 0.026 8.14 -0.37 -2.4    a sample (ParseInertialSample)
//   frame 1403636579763555584       stamp in nanoseconds
//   <752*480 bytes of left><752*480 bytes of right>...
//   frame 1403636579813555456
//   ...
//   missing 1403636592913555456     a frame that the sender could not get
//
// Encodings and their bytes: raw_pixels.h, 16 and 32 bits little-endian. Rows have no padding.
// Images come in the order of the header. Samples of an inertial sensor come before the first frame
// whose stamp is not before theirs; those that cannot be used are left out. The end of the stream
// is the end of the run; an end within a frame loses that frame only.
//
// Reads the header from the file descriptor, which stays open. Data in another format throw an
// InputError that begins with "standard input:": a wrong header at once, a wrong frame in Next.
std::unique_ptr<LiveSource> OpenRawStream(int descriptor, const LiveOptions& options);

// Returns the description of a source called `name` with data for these sensors, the richest first,
// with the camera file of the options. Throws InputError if that file is not given, if it has one
// camera but two are needed, or if the source does not offer the requested sensor.
DatasetInfo DescribeLive(const std::string& name,
                         std::vector<SensorKind> available,
                         const LiveOptions& options);

// Throws InputError unless the images have the size of the camera.
void CheckLiveSize(const std::string& name, ImageSize size, const Camera& camera);

}  // namespace plumbline
