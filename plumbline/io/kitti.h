// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"

#include <filesystem>
#include <memory>
#include <vector>

namespace plumbline {

// Returns the possible files of the true poses of a sequence: poses.txt in its folder and, as
// distributed, ../../poses/<sequence>.txt.
std::vector<std::filesystem::path> KittiPosesFiles(const std::filesystem::path& sequence);

// Opens a sequence of KITTI odometry (image_0/, image_1/, calib.txt, times.txt) or a drive of KITTI
// raw (image_00/data/, image_00/timestamps.txt, calib_cam_to_cam.txt there or in the folder of the
// day), rectified or as taken. The grey cameras 0 and 1 are used, or without camera 0 the colour
// cameras 2 and 3. Image N belongs to row N of the times, from 0. Ground truth is that of
// KittiPosesFiles, poses of the rectified camera 0. Throws the errors of OpenDataset.
std::unique_ptr<Dataset> OpenKitti(const std::filesystem::path& path,
                                   const DatasetOptions& options);

}  // namespace plumbline
