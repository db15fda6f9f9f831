// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/command_inputs.h"

#include "plumbline/geometry/calibration.h"
#include "plumbline/io/live/live_source.h"

#include <filesystem>
#include <string>
#include <system_error>

namespace plumbline {

std::vector<RunInput> CommandInputs(const CommandLine& line, const Dataset& dataset) {
  std::vector<RunInput> inputs;
  if (!LiveKindOf(line.Positional(0))) inputs.push_back({line.Positional(0)});
  std::error_code error;
  const auto add = [&](const std::filesystem::path& path) {
    if (std::filesystem::is_regular_file(path, error)) inputs.push_back({path});
  };
  for (const char* option : {"--camera", "--imu", "--poses", "--config", "--mask"}) {
    for (const std::string& path : line.Values(option)) add(path);
  }
  if (dataset.info().ground_truth) add(dataset.info().ground_truth->path);
  return inputs;
}

Rotation ReadRotation(const CommandLine& line) {
  const auto text = line.Value("--rotate");
  return text ? ParseChoice<Rotation>("--rotate", *text) : Rotation::kAuto;
}

std::optional<int> ReadMaxWidth(const CommandLine& line) {
  constexpr int kNarrowest = 16;  // pixels; nothing is left to see by then
  if (!line.Has("--max-width")) return std::nullopt;
  return line.Count("--max-width", 0, {kNarrowest, kLongestSide});
}

std::optional<double> ReadViewAngle(const CommandLine& line) {
  if (!line.Has("--view-angle")) return std::nullopt;
  return line.Count("--view-angle", 0, {10, 150});
}

}  // namespace plumbline
