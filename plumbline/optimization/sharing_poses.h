// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/optimization/elimination_plan.h"
#include "plumbline/optimization/problem.h"

namespace plumbline {

// Returns for each pose of a problem the earlier poses that share a point or a line with it: the
// nonzero blocks of the reduced camera system. When stopped, the pattern is incomplete and useless.
//
//   cost  O(sum over the landmarks of their observations squared); memory in proportion to the
//         observations and the pairs
BlockPattern SharingPoses(const BaProblem& problem, const StopCheck& stop = {});

}  // namespace plumbline
