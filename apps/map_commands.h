// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

namespace plumbline {

// What `plumbline map` can do, one in each file map_*.cc; as the commands of commands.h.
// `arguments` are those behind "map info" and so on.
int MapInfoCommand(std::span<const std::string> arguments);
int MapExportCommand(std::span<const std::string> arguments);
int MapMergeCommand(std::span<const std::string> arguments);
int MapViewCommand(std::span<const std::string> arguments);

}  // namespace plumbline
