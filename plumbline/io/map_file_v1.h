// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/saved_atlas.h"

#include <filesystem>
#include <functional>

namespace plumbline {

// Reads a map file of version 1, which holds one map: its keyframes, landmarks and the camera. What
// it does not hold is unknown in the result, or as in a map that took in these keyframes and no
// others. Its disparities, which had the run's stereo correction, count as measured. Features are
// rounded to single precision. `check` is called with the context before the map is made. Throws
// the InputErrors of LoadAtlas.
SavedAtlas LoadMapFileV1(const std::filesystem::path& path,
                         const std::function<void(const AtlasContext&)>& check);

}  // namespace plumbline
