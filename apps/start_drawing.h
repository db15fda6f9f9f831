// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/initialization/initializer.h"

#include <filesystem>

namespace plumbline {

// Writes a PNG of the first and the newest view of a map side by side: their common points with
// their displacement, coloured by depth from red (nearest) to blue (furthest of the map), and the
// lines. Does nothing if the views have no images.
void WriteStartDrawing(const InitialMap& map,
                       const RectifiedCamera& camera,
                       const std::filesystem::path& path);

}  // namespace plumbline
