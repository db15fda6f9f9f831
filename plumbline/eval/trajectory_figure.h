// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/eval/figure.h"
#include "plumbline/eval/trajectory_error.h"

namespace plumbline {

// Draws the evaluated trajectory from above beside its reference, and below it the position error
// over time. "Above" is along the axis in which the reference moves least.
Figure TrajectoryFigure(const TrajectoryError& error);

}  // namespace plumbline
