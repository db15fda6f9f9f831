// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"

#include <filesystem>
#include <memory>

namespace plumbline {

// Opens a video file as a monocular sequence. Its calibration is the camera file named by the
// options, or a camera.yaml beside the video.
//
// Times are the display times in the container, since its start. A frame without a time follows the
// previous one by the container's rate, with a note. Frames still without one, and the fewest
// possible others, are left out with a note so that times increase; if this affects more than half
// of all, frames are the container's frame period apart, with a note. Frames removed by an edit
// list do not count. Images are rotated as the container says (ChooseTurn).
//
// Frames are best read in order: going back means decoding from the start. Throws the errors of
// OpenDataset, and InputError for a file that is no video, has no frames, or differs in size from
// the calibration. Cost: the whole video is decoded once, since containers are often wrong about
// the number and times of their frames.
std::unique_ptr<Dataset> OpenVideo(const std::filesystem::path& path,
                                   const DatasetOptions& options);

}  // namespace plumbline
