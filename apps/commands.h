// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

namespace plumbline {

// The subcommands, one in each file of this folder. `arguments` are those after the name of the
// command; the result is the exit code. Bad input or usage is thrown as InputError, which main
// prints in one line and turns into exit code 2. A new command needs a file, a line here, and a row
// in main.cc. Those of the worlds and of the laboratory exist if these are built.
int ConfigCommand(std::span<const std::string> arguments);
int ConsistencyCommand(std::span<const std::string> arguments);
int EvaluateCommand(std::span<const std::string> arguments);
int ExperimentCommand(std::span<const std::string> arguments);
int InfoCommand(std::span<const std::string> arguments);
int LinesCommand(std::span<const std::string> arguments);
int MapCommand(std::span<const std::string> arguments);
int RunCommand(std::span<const std::string> arguments);
int StartsCommand(std::span<const std::string> arguments);
int SynthCommand(std::span<const std::string> arguments);

}  // namespace plumbline
