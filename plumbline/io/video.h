// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"

#include <filesystem>
#include <memory>

namespace plumbline {

// Opens a video file as a monocular sequence. Its calibration is the camera file that the options
// name, or a camera.yaml beside the video.
//
// Times are those at which the container shows its frames, since its start. A frame without a time
// follows the one before by the container's rate, with a note. Frames still without one, and as few
// others as can be, are left out with a note so that times increase; where more than half of all
// would be, frames are the container's frame rate apart, with a note. Frames that an edit list cuts
// away are no frames. Images are turned as the container asks (ChooseTurn).
//
// Frames are best read in order: going back means decoding from the start. Throws the errors of
// OpenDataset, and InputError for a file that is no video, has no frames, or is of another size
// than the calibration's. Cost: the whole video is decoded once, since containers are often wrong
// about the number and times of their frames.
std::unique_ptr<Dataset> OpenVideo(const std::filesystem::path& path,
                                   const DatasetOptions& options);

}  // namespace plumbline
