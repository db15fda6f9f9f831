// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/datasets/dataset.h"

#include <filesystem>
#include <memory>
#include <optional>

namespace plumbline {

// Returns the format of a recorded sequence; nullopt if it is missing. A file is recognized by its
// first bytes, otherwise by the end of its name, and is a video if neither matches; a folder by the
// names in it.
std::optional<DatasetFormat> FindFormat(const std::filesystem::path& path);

// Opens a EuRoC folder (with mav0/), a TUM or ICL folder (rgb.txt), a KITTI sequence (image_0/ and
// calib.txt), a folder of images, a bag of ROS 1 or ROS 2 (a folder of ros2 bag or a file of it),
// an MCAP file or a video file, and reads its lists, calibration and ground truth, not its images
// (a video is decoded once, see video.h, and a bag or an MCAP file read once). Throws InputError
// naming file and line for missing or malformed data, and if the data does not have the requested
// sensor.
std::unique_ptr<Dataset> OpenDataset(const std::filesystem::path& path,
                                     const DatasetOptions& options = {});

}  // namespace plumbline
