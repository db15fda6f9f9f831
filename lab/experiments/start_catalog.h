// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/experiment.h"

#include <vector>

namespace plumbline {

// How a monocular map begins: several methods, parts of the default left out, and numbers of frames
// and of points.
std::vector<Experiment> StartExperiments();

}  // namespace plumbline
