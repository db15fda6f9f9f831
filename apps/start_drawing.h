// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/initialization/initializer.h"

#include <filesystem>

namespace plumbline {

// Writes a PNG of the first and the newest view of a map beside each other: the points both show
// with the way from one to the other, red for the nearest to blue for the furthest of the map, and
// the lines. Nothing where the views have no images.
void WriteStartDrawing(const InitialMap& map,
                       const RectifiedCamera& camera,
                       const std::filesystem::path& path);

}  // namespace plumbline
