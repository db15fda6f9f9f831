// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

namespace plumbline {

// Returns the text of each file of configs/presets, by its name without .yaml.
const std::map<std::string, std::string>& PresetFiles();

}  // namespace plumbline
