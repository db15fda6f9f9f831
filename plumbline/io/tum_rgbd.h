// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"

#include <filesystem>
#include <memory>

namespace plumbline {

// Opens a folder in TUM RGB-D form (rgb.txt, depth.txt, groundtruth.txt; ICL-NUIM without
// depth.txt). A colour image and a depth image are paired if they are mutually nearest in time and
// at most 20 ms apart. Other images are left out of RGB-D, with a note. Throws the errors of
// OpenDataset.
std::unique_ptr<Dataset> OpenTum(const std::filesystem::path& path, const DatasetOptions& options);

}  // namespace plumbline
