// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/experiment.h"

#include <span>
#include <string_view>
#include <vector>

namespace plumbline {

// The tables and figures of the two papers that runs can make, named after them: rippl-* of Lee and
// Hwang 2019, cutting-* of Zhao and Vela 2018. Loops stay open, as in the papers. Variants have the
// papers' names; what the papers print stands in printed/*.yaml under the same names. Beside the
// papers' sequences there are others that stand in for those that are not at hand.
std::vector<Experiment> PaperExperiments();

// A few minutes on rendered worlds and on what recorded sequences there are, whose figures must
// keep the limits of gate_limits.yaml (gate.h).
Experiment GateExperiment();

// The maps of lines of three worlds, in several runs: seeds of one world differ by a tenth, which
// their mean does not.
Experiment LineGateExperiment();

std::span<const ExperimentGroup> ExperimentGroups();

// nullptr for an unknown name.
const ExperimentGroup* FindExperimentGroup(std::string_view name);

}  // namespace plumbline
