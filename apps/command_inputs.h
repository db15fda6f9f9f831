// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"
#include "plumbline/report/run_folder.h"

#include "apps/command_line.h"
#include <vector>

namespace plumbline {

// What a command reads: the data set, which is the first positional argument, the files of
// --camera, --poses and --config, as far as they are given, and the ground truth. A live source,
// what comes from a pipe, and a camera that is built in have no place.
std::vector<RunInput> CommandInputs(const CommandLine& line, const Dataset& dataset);

}  // namespace plumbline
