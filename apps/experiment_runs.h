// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/catalog.h"
#include "lab/experiments/computed.h"

#include "apps/command_line.h"

namespace plumbline {

// What a run of `plumbline experiment` does for one experiment, for those of a group, and for one
// that computes by itself. Returns the exit code: 1 where a limit of a gate is broken.
int RunExperiment(const Experiment& experiment, const CommandLine& line);
int RunGroup(const ExperimentGroup& group, const CommandLine& line);
int RunComputed(const ComputedExperiment& experiment, const CommandLine& line);

}  // namespace plumbline
