// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"
#include "plumbline/base/options.h"
#include "plumbline/io/datasets/dataset.h"

#include <exception>
#include <string>
#include <type_traits>

#include <fmt/core.h>

namespace plumbline {

// Values of the command lines of benchmarks that play sequences. Both throw InputError, which names
// the option and the expected value.
inline int ParseCount(const std::string& name, const std::string& text) {
  std::size_t used = 0;
  int value = -1;
  try {
    value = std::stoi(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used != text.size() || text.empty() || value < 0) {
    throw InputError(fmt::format("{} {}: expected a number from 0 on", name, text));
  }
  return value;
}

inline SensorKind ParseSensor(const std::string& text) {
  for (const auto& [kind, name] : EnumNames(std::type_identity<SensorKind>{})) {
    if (text == name) return kind;
  }
  throw InputError(fmt::format("--sensor {}: expected mono, stereo or rgbd", text));
}

}  // namespace plumbline
