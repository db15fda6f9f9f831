// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options_io.h"

#include <string>
#include <string_view>
#include <vector>

namespace plumbline {

// Named set of options: the system of a paper. The options are in configs/presets/NAME.yaml, which
// is compiled into the library, as camera files are.
struct Preset {
  std::string name;
  std::string help;           // one sentence
  bool needs_stereo = false;  // true: for a stereo pair; false: for one camera
  std::string yaml;           // a file of options (OptionTable::LoadText)
};

// Returns all presets in the order of their names.
const std::vector<Preset>& Presets();

// Returns the preset of this name. Throws InputError, which names all presets, if it is unknown.
const Preset& FindPreset(std::string_view name);

// Sets the options of a preset, and returns it. Throws as FindPreset.
const Preset& LoadPreset(std::string_view name, OptionTable& table);

}  // namespace plumbline
