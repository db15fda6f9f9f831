// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worlds/world.h"

#include <filesystem>
#include <string>

namespace plumbline {

// Reads the description of a world from a YAML file: shapes with their materials, lamps, moving
// bodies, the path of the camera, and its recording. docs/worlds.md describes the format.
//
// Everything is checked here, so that `make` of the result succeeds for every seed, which
// determines the textures and the carrier's motions. Throws InputError "FILE:LINE: key: expected
// ..., found ...".
WorldSource ReadWorldFile(const std::filesystem::path& file);

// The same for the text of a file; `source` is its name in messages.
WorldSource ParseWorldFile(const std::string& text, const std::string& source);

}  // namespace plumbline
