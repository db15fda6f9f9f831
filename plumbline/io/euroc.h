// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"

#include <filesystem>
#include <memory>

namespace plumbline {

// Opens a EuRoC folder (mav0/cam0, cam1: data.csv, sensor.yaml; ground truth in
// state_groundtruth_estimate0, of the body). `path` is the folder above mav0 or mav0 itself. Left
// and right frames with equal stamps form a pair; others are left out, with a note. Throws the
// errors of OpenDataset.
std::unique_ptr<Dataset> OpenEuroc(const std::filesystem::path& path,
                                   const DatasetOptions& options);

}  // namespace plumbline
