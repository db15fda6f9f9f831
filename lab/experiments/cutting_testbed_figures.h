// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/cutting_testbed/testbed.h"
#include "lab/experiments/figure_list.h"
#include "lab/experiments/table_page.h"

#include <span>
#include <vector>

namespace plumbline {

// The metrics of the testbed of line cutting.
std::span<const FigureMetric> CuttingTestbedMetrics();

// Returns the figures of the trials, without seeds. Sequences: single/..., joint/..., pose/... with
// kind, noise and number of lines of the scenes, or `all` for several taken together; choice/...
// with the budget and the numbers of points and lines.
std::vector<FigureRow> CuttingTestbedFigures(const TestbedTrials& trials);

// Returns the times of the optimizers, which differ from run to run.
std::vector<FigureRow> CuttingTestbedTimes(const TestbedTrials& trials);

// camera_path (Figure 2), surface_* (Figure 3), joint_* (Figure 4), pose_error.
std::vector<PagePlot> CuttingTestbedPlots(const TestbedTrials& trials);

}  // namespace plumbline
