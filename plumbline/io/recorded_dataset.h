// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"

#include <filesystem>
#include <memory>

namespace plumbline {

// Opens a ROS 1 bag or an MCAP file. recorded_topics.h says which of its topics are the cameras.
// Times are those of the sensor (header.stamp), or those of recording where it set none. Images of
// a pair belong together when their stamps are nearest to each other and within 5 ms; an image and
// its depth within 20 ms. Depth of 16 bits is in millimetres unless the camera file has a
// depth_factor.
//
// The calibration is the camera file that the options name, a camera.yaml beside the file, or what
// the file says (recorded_calibration.h). There is no ground truth. Throws the errors of
// OpenDataset. Cost: the whole file is read and unpacked once, some hundred megabytes a second.
std::unique_ptr<Dataset> OpenRecording(const std::filesystem::path& path,
                                       DatasetFormat format,
                                       const DatasetOptions& options);

}  // namespace plumbline
