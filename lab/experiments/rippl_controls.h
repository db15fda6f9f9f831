// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/experiment.h"

namespace plumbline {

// The start of the first paper (Lee and Hwang 2019, section 2; preset rippl) with each of its parts
// left out, by more frames and fewer points, and beside two views. Each variant differs in one
// thing from the one that it is compared with (docs/experiments.md says what each measures), but
// for two_view, which is another method.
Experiment RipplControls();

}  // namespace plumbline
