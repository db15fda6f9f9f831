// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/atlas.h"

#include "apps/command_line.h"

namespace plumbline {

// The option that ChooseMap reads.
inline const CommandOption kMapOption = {
    "--map", "N", "the map of this number (default: the one to go on with)"};

// Makes the map that --map names the active one, and returns it; without --map the one that is to
// be gone on with. Throws InputError where the file, the first argument, has no such map, or none.
Map& ChooseMap(const CommandLine& line, Atlas& atlas);

}  // namespace plumbline
