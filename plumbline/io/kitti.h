// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"

#include <filesystem>
#include <memory>
#include <optional>

namespace plumbline {

// Returns the file of the true poses of a sequence: poses.txt in its folder or, as distributed,
// ../../poses/<sequence>.txt; nullopt where there is neither.
std::optional<std::filesystem::path> KittiPosesFile(const std::filesystem::path& sequence);

// Opens a KITTI odometry sequence (image_0/, image_1/, calib.txt, times.txt; ground truth as of
// KittiPosesFile). Throws the errors of OpenDataset.
std::unique_ptr<Dataset> OpenKitti(const std::filesystem::path& path,
                                   const DatasetOptions& options);

}  // namespace plumbline
