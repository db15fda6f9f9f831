// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "worlds/world_file.h"

#include "fuzz/input_folder.h"
#include <string>

// Descriptions of worlds; what was accepted can be made with every seed.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumbline;
  try {
    const WorldSource world = ParseWorldFile(std::string(AsText(data, size)), "input");
    try {
      world.make(7);
    } catch (const InputError& error) {
      throw BugError(error.what());
    }
  } catch (const InputError&) {
  }
  return 0;
}
