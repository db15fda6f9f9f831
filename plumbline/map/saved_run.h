// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/saved_atlas.h"

#include <string>

namespace plumbline {

// A run in the middle: all that is needed to go on with the next frame as if it had never stopped.
struct SavedRun {
  SavedAtlas maps;    // the maps and what they were made with; the options are those of the run
  std::string state;  // everything else, in bytes that only the system understands
  // What the frames were, in words of those who feed them; "" where they said nothing.
  std::string input;
};

}  // namespace plumbline
