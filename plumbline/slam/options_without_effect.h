// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/slam/options.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumbline {

// Returns the dotted keys of the options that differ, in the order of the options.
std::vector<std::string> DifferentOptions(SlamOptions a, SlamOptions b);

// Returns a line for each option that leaves others without effect:
// "cutting.method, cutting.ends: no effect with features.lines=false".
//
//   set      dotted keys of the options to check: those that the user has set. Others are unknown
//   to
//            the user, or from a preset
//   sensor   name of the sensor as --sensor has it: mono, stereo or rgbd; nullopt: unknown
//   has_map  true if the run goes on in a map, whose points and lines take part though
//            features.points or features.lines is off
std::vector<std::string> OptionsWithoutEffect(const SlamOptions& options,
                                              const std::vector<std::string>& set,
                                              std::optional<std::string_view> sensor = {},
                                              bool has_map = false);

}  // namespace plumbline
