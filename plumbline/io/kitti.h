// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"

#include <filesystem>
#include <memory>
#include <vector>

namespace plumbline {

// Returns the files that may have the true poses of a sequence: poses.txt in its folder and, as
// distributed, ../../poses/<sequence>.txt.
std::vector<std::filesystem::path> KittiPosesFiles(const std::filesystem::path& sequence);

// Opens a KITTI odometry sequence (image_0/, image_1/, calib.txt, times.txt; ground truth as of
// KittiPosesFiles). Image N belongs to row N of the times, from 0. Throws the errors of
// OpenDataset.
std::unique_ptr<Dataset> OpenKitti(const std::filesystem::path& path,
                                   const DatasetOptions& options);

}  // namespace plumbline
