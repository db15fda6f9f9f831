// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/optimization/problem.h"

namespace plumbline {

// Throws BugError where an observation names a pose, landmark or axis that the problem does not
// have, or a parallel line has no positive sigma.
void CheckIndices(const BaProblem& problem);

// Whether all numbers of a problem are finite.
bool IsFinite(const BaProblem& problem);

}  // namespace plumbline
