// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/saved_atlas.h"

#include <string>

namespace plumbline {

// A run in the middle: what is needed to go on with the next frame as if it had never stopped.
struct SavedRun {
  SavedAtlas maps;    // and what they were made with; the options are those of the run
  std::string state;  // all else, in bytes that the system alone understands
  std::string input;  // what the frames were, in words of whoever feeds them; "" where not said
};

}  // namespace plumbline
