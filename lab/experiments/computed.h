// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/computed_experiment.h"

#include <span>
#include <string_view>

namespace plumbline {

// All computed experiments. A new one needs an entry here.
std::span<const ComputedExperiment> ComputedExperiments();

// nullptr for an unknown name.
const ComputedExperiment* FindComputedExperiment(std::string_view name);

}  // namespace plumbline
