// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"

#include <filesystem>
#include <memory>

namespace plumbline {

// Opens a folder of images, which are in natural order of their names and `rate_hz` of the camera
// file apart. Throws the errors of OpenDataset.
std::unique_ptr<Dataset> OpenImageFolder(const std::filesystem::path& path,
                                         const DatasetOptions& options);

}  // namespace plumbline
