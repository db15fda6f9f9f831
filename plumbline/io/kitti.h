// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"

#include <filesystem>
#include <memory>

namespace plumbline {

// Opens a KITTI odometry sequence (image_0/, image_1/, calib.txt, times.txt; ground truth in
// poses.txt or, as distributed, in ../../poses/<sequence>.txt). Throws the errors of OpenDataset.
std::unique_ptr<Dataset> OpenKitti(const std::filesystem::path& path,
                                   const DatasetOptions& options);

}  // namespace plumbline
