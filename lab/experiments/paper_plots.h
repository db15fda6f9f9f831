// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/job_runner.h"
#include "lab/experiments/table_page.h"
#include "plumbline/report/figure.h"

#include <vector>

namespace plumbline {

// Returns the plots of Experiment::paper_plot, from the folders of the runs: the first run of each
// variant on each sequence that has one. Unreadable runs are left out.
std::vector<PagePlot> PaperPlots(const Plan& plan, const std::vector<JobResult>& results);

// Figure 8 of the first paper. One panel with the mean error of the relative position (runs without
// a map count as 1 m, as in the paper) over the mean number of frames until there is a map, for
// each number of frames solved together; one over that number; one over the points in an image.
Figure ConvergencePlot(const Plan& plan, const std::vector<JobResult>& results);

// Figure 9 of the first paper: the path of each variant on a sequence beside the true one, from
// above.
Figure PathPlot(const Plan& plan, const std::vector<JobResult>& results, std::size_t sequence);

// Figure 6 of the first paper, for one variant: the landmarks made in the first 15 % of the time
// black, those made in the last 15 % red, the path blue and the true one grey, from above.
Figure RevisitPlot(const Plan& plan, const Job& job);

// Figure 5 of the second paper: the image of a keyframe in the middle of the run with the measured
// lines green and their projected cut pieces red. An SVG with the image in it. Throws InputError if
// images or map cannot be read, or there is no keyframe with lines.
std::string CutLinePlot(const Plan& plan, const Job& job);

}  // namespace plumbline
