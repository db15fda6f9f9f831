// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/optimization/problem.h"

namespace plumbline {

// Throws BugError if an observation has an index of no pose, landmark or axis, or if a parallel
// line has no positive sigma.
void CheckIndices(const BaProblem& problem);

// Returns true if all numbers of a problem are finite.
bool IsFinite(const BaProblem& problem);

}  // namespace plumbline
