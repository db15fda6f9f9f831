// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/line_maps/line_map_error.h"

#include <string>

namespace plumbline {

// Returns the errors of a line map, and what was asked for, as a small table with units.
std::string LineMapTable(const LineMapError& error, const LineMapErrorOptions& options);

// Returns the same as a JSON object, in metres and degrees; shares are in [0, 1]. `tolerances` is a
// list with the results at each of them. Shares and medians of nothing are null.
std::string LineMapJson(const LineMapError& error, const LineMapErrorOptions& options);

}  // namespace plumbline
