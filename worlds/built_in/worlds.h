// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worlds/world.h"

#include <cstdint>

namespace plumbline {

// One function for each world, each in a file of its name; world_catalog.cc lists them.
World MakeRoom(std::uint64_t seed);
World MakeLowTexture(std::uint64_t seed);
World MakeViconEasy(std::uint64_t seed);
World MakeViconMedium(std::uint64_t seed);
World MakeViconDifficult(std::uint64_t seed);
World MakeOffice(std::uint64_t seed);
World MakeLoop(std::uint64_t seed);
World MakeFloors(std::uint64_t seed);
World MakePlanar(std::uint64_t seed);
World MakeForward(std::uint64_t seed);
World MakeLateral(std::uint64_t seed);
World MakeDegenerate(std::uint64_t seed);
World MakeTown(std::uint64_t seed);
World MakeRotation(std::uint64_t seed);
World MakeStatic(std::uint64_t seed);
World MakeLights(std::uint64_t seed);
World MakeDynamic(std::uint64_t seed);
World MakeWires(std::uint64_t seed);

}  // namespace plumbline
