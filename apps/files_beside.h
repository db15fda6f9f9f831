// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"
#include "plumbline/report/run_folder.h"

#include "apps/command_line.h"
#include <vector>

namespace plumbline {

// The files that a command reads beside a data set: those of --camera, --poses and --config, as far
// as they are given, and the ground truth. What comes from a pipe, and a camera that is built in,
// has no place.
std::vector<RunInput> FilesBeside(const CommandLine& line, const Dataset& dataset);

}  // namespace plumbline
