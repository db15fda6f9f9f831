// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/experiment.h"

#include <span>
#include <string_view>

namespace plumbline {

// The experiments there are. A new one is an entry here, or in paper_catalog.cc, and nothing else.
std::span<const Experiment> Experiments();

// Throws InputError for an unknown name, with the names there are.
const Experiment& FindExperiment(std::string_view name);

}  // namespace plumbline
