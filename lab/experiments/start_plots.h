// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/start_pools.h"
#include "lab/experiments/table.h"
#include "lab/experiments/table_page.h"

#include <vector>

namespace plumbline {

// Plots of starts, a panel for each pool:
//   start_time    share of the possible starts that have a right map, over the seconds of video
//   start_errors  share of the maps below an error: rotation, direction, inverse depth
// An experiment with an abscissa gets plots of its metrics over it instead, one each.
std::vector<PagePlot> StartPlots(const Plan& plan, const StartsByJob& starts);

}  // namespace plumbline
