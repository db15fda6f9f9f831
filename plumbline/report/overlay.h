// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/slam/system.h"

#include <filesystem>

namespace plumbline {

// Writes the rectified left image of the last frame as PNG with its features: matched points green,
// others grey; matched lines orange, others blue.
void WriteFeatureOverlay(const FrameView& view, const std::filesystem::path& path);

}  // namespace plumbline
