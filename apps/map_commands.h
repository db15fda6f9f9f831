// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace plumbline {

// What `plumbline map` can do, one in each file map_*.cc; as the commands of commands.h.
// `arguments` are those behind "map info" and so on.
int MapInfoCommand(std::span<const std::string> arguments);
int MapExportCommand(std::span<const std::string> arguments);
int MapMergeCommand(std::span<const std::string> arguments);
int MapViewCommand(std::span<const std::string> arguments);

// Throws InputError where `output` is the file `input`, by whatever name: reading it is no leave to
// write over it.
void RefuseToReplaceInput(const std::filesystem::path& output, const std::filesystem::path& input);

}  // namespace plumbline
