// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/experiment.h"

#include <span>
#include <string_view>

namespace plumbline {

// All experiments. A new one needs only an entry here, or in paper_catalog.cc.
std::span<const Experiment> Experiments();

// Throws InputError for an unknown name, with all names.
const Experiment& FindExperiment(std::string_view name);

}  // namespace plumbline
