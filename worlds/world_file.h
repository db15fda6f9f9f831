// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worlds/world.h"

#include <filesystem>
#include <string>

namespace plumbline {

// Reads the description of a world from a YAML file: shapes with their materials, lamps, bodies
// that move, the way of the camera, and how it is recorded. The form is told in docs/worlds.md.
//
// Everything is checked here, so that `make` of the result succeeds for every seed, which gives the
// textures and the carrier's motions. Throws InputError "FILE:LINE: key: expected ..., found ...".
WorldSource ReadWorldFile(const std::filesystem::path& file);

// The same of the text of a file; `source` stands for its name in messages.
WorldSource ParseWorldFile(const std::string& text, const std::string& source);

}  // namespace plumbline
