// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/command_outputs.h"
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace plumbline {

// What `plumbline map` can do, one in each file map_*.cc; as the commands of commands.h.
// `arguments` are those behind "map info" and so on.
int MapInfoCommand(std::span<const std::string> arguments);
int MapExportCommand(std::span<const std::string> arguments);
int MapMergeCommand(std::span<const std::string> arguments);
int MapViewCommand(std::span<const std::string> arguments);

// Throws InputError, which names the option, where writing `output` would take the place of what is
// read (by whatever name: reading it is no leave to write over it), of a result of a run, or of a
// file of another kind.
void CheckMapOutput(std::string_view option,
                    const std::filesystem::path& output,
                    std::span<const std::string> inputs,
                    const FileKind& kind);

}  // namespace plumbline
