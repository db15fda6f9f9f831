// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"

#include <filesystem>
#include <memory>

namespace plumbline {

// Opens a video file as a monocular sequence. Its calibration is the camera file that the options
// name, or a camera.yaml beside the video. Times are those of the container; where it has none, or
// they do not increase, frames are the container's frame rate apart. A rotation that the container
// asks for is ignored, with a note: the calibration is of the raw pixels.
//
// Frames are best read in order: going back means decoding from the start. Throws the errors of
// OpenDataset, and InputError for a file that is no video, has no frames, or is of another size
// than the calibration's. Cost: the whole video is decoded once, since containers are often wrong
// about the number and times of their frames.
std::unique_ptr<Dataset> OpenVideo(const std::filesystem::path& path,
                                   const DatasetOptions& options);

}  // namespace plumbline
