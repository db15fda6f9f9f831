// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/preset.h"

#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"
#include "plumbline/slam/preset_files.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumbline {

const std::vector<Preset>& Presets() {
  static const std::vector<Preset> presets = {
      {"good-line-cutting",
       "odometry with a stereo pair: Zhao and Vela, Good Line Cutting (ECCV 2018)",
       true,
       PresetFiles().at("good-line-cutting")},
      {"rippl",
       "SLAM with one camera: Lee and Hwang, Elaborate Monocular Point and Line SLAM (ICCV 2019)",
       false,
       PresetFiles().at("rippl")}};
  return presets;
}

const Preset& FindPreset(std::string_view name) {
  const std::vector<Preset>& presets = Presets();
  const auto found = std::find_if(
      presets.begin(), presets.end(), [&](const Preset& preset) { return preset.name == name; });
  if (found != presets.end()) return *found;
  std::vector<std::string> names;
  for (const Preset& preset : presets) names.push_back(preset.name);
  throw InputError(fmt::format(
      "preset: expected {}, found {}", fmt::join(names, " or "), InQuotes(std::string(name))));
}

const Preset& LoadPreset(std::string_view name, OptionTable& table) {
  const Preset& preset = FindPreset(name);
  table.LoadText(preset.yaml, "preset " + preset.name);
  return preset;
}

}  // namespace plumbline
