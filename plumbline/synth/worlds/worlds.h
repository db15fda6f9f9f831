// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/synth/world.h"

#include <cstdint>

namespace plumbline {

// One function for each world, each in a file of its name; world.cc lists them.
World MakeRoom(std::uint64_t seed);
World MakeLowTexture(std::uint64_t seed);

}  // namespace plumbline
