// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"

#include <filesystem>
#include <memory>
#include <optional>

namespace plumbline {

// Returns how a recorded sequence is stored; nullopt where there is none. A file is known by its
// first bytes, else by the end of its name, and is otherwise a video; a folder is known by the
// names in it.
std::optional<DatasetFormat> FindFormat(const std::filesystem::path& path);

// Opens a EuRoC folder (with mav0/), a TUM or ICL folder (rgb.txt), a KITTI sequence (image_0/ and
// calib.txt), a folder of images, a bag of ROS 1 or ROS 2 (a folder of ros2 bag or a file of it),
// an MCAP file or a video file, and reads its lists, calibration and ground truth, not its images
// (a video is decoded once, see video.h, and a bag or an MCAP file read once). Throws InputError
// naming file and line for what is missing or malformed, and where the data does not offer the
// sensor asked for.
std::unique_ptr<Dataset> OpenDataset(const std::filesystem::path& path,
                                     const DatasetOptions& options = {});

}  // namespace plumbline
