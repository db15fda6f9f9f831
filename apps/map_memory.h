// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/atlas.h"

#include <cstddef>
#include <string>
#include <vector>

namespace plumbline {

// Bytes of one kind of a map's data, in memory.
struct MemoryOfKind {
  std::string kind;
  std::size_t bytes = 0;
};

// Returns the memory of all maps of an atlas by kind, the reserves of vectors included: features of
// the keyframes, the index of their positions, matches, points, lines, observations and tables.
// Features that keyframes share count once for each.
std::vector<MemoryOfKind> MemoryOf(const Atlas& atlas);

}  // namespace plumbline
