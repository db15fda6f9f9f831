// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"

#include <filesystem>
#include <memory>

namespace plumbline {

// Opens a ROS 1 bag or an MCAP file. recorded_topics.h selects the topics of the cameras. Times are
// those of the sensor (header.stamp), or those of recording if they are not set. Images whose
// stamps are mutually nearest and within 5 ms form a pair; an image and its depth within 20 ms.
// Depth of 16 bits is in millimetres unless the camera file has a depth_factor.
//
// The calibration is the camera file named by the options, a camera.yaml beside the file, or that
// of the recording (recorded_calibration.h). There is no ground truth. Throws the errors of
// OpenDataset. Cost: the whole file is read and unpacked once, some hundred megabytes a second.
std::unique_ptr<Dataset> OpenRecording(const std::filesystem::path& path,
                                       DatasetFormat format,
                                       const DatasetOptions& options);

}  // namespace plumbline
