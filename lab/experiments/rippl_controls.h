// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/experiment.h"

namespace plumbline {

// Initialization of the first paper (Lee and Hwang 2019, section 2; preset rippl) with each of its
// parts left out, with more frames and fewer points, and two-view initialization. Each variant
// differs in one thing from its reference (lab/notes/rippl-tables.md says what each varies), except
// two_view, which is another method.
Experiment RipplControls();

}  // namespace plumbline
