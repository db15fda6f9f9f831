// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/experiment.h"

#include <span>
#include <string_view>
#include <vector>

namespace plumbline {

// The tables and figures of the two papers that are reproducible by runs, named after them: rippl-*
// of Lee and Hwang 2019, cutting-* of Zhao and Vela 2018. Loops stay open, as in the papers.
// Variants have the papers' names; the papers' figures are in printed/*.yaml under the same names.
// In addition to the papers' sequences there are others that replace unavailable ones.
std::vector<Experiment> PaperExperiments();

// A few minutes on rendered worlds and on the available recorded sequences, whose figures must keep
// the limits of gate_limits.yaml (gate.h).
Experiment GateExperiment();

// Line maps of three worlds, in several runs: single seeds of one world differ by a tenth, their
// mean does not.
Experiment LineGateExperiment();

std::span<const ExperimentGroup> ExperimentGroups();

// nullptr for an unknown name.
const ExperimentGroup* FindExperimentGroup(std::string_view name);

}  // namespace plumbline
