// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/atlas.h"

#include "apps/command_line.h"

namespace plumbline {

// The option that ChooseMap reads.
inline const CommandOption kMapOption = {
    "--map", "N", "the map of this number (default: the one to go on with)"};

// Makes the map named by --map the active one, and returns it; without --map the active map. Throws
// InputError if the file, the first argument, does not have the map, or has none.
Map& ChooseMap(const CommandLine& line, Atlas& atlas);

}  // namespace plumbline
