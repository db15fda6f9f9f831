// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"

#include <filesystem>
#include <memory>

namespace plumbline {

// Opens a folder of images, in natural order of their names and at the `rate_hz` of the camera
// file. Throws the errors of OpenDataset.
std::unique_ptr<Dataset> OpenImageFolder(const std::filesystem::path& path,
                                         const DatasetOptions& options);

}  // namespace plumbline
