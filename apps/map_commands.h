// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

namespace plumbline {

// The subcommands of `plumbline map`, one in each file map_*.cc; like those of commands.h.
// `arguments` are those after "map info" and so on.
int MapInfoCommand(std::span<const std::string> arguments);
int MapExportCommand(std::span<const std::string> arguments);
int MapMergeCommand(std::span<const std::string> arguments);
int MapViewCommand(std::span<const std::string> arguments);

}  // namespace plumbline
