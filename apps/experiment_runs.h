// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/catalog.h"
#include "lab/experiments/computed.h"

#include "apps/command_line.h"

namespace plumbline {

// Execute `plumbline experiment` for one experiment, for a group, and for one that computes by
// itself. Return the exit code: 1 if a limit of a gate is exceeded.
int RunExperiment(const Experiment& experiment, const CommandLine& line);
int RunGroup(const ExperimentGroup& group, const CommandLine& line);
int RunComputed(const ComputedExperiment& experiment, const CommandLine& line);

}  // namespace plumbline
