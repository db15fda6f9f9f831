// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/line_cutting/pose_information.h"

#include <cstddef>

namespace plumbline {

// Best cut of one line, with all other lines fixed: gradient ascent from full length and from
// either end (second paper, 5.1). It is the best of the three results, or the current cut if none
// is better. A piece of length zero at an end is stationary across the diagonal: both ratios have
// the same gradient, and no ascent from there leads to two different ratios. The starts at the ends
// are therefore 0.02 long. `rest` are the sums over the other lines.
struct SingleLineCut {
  LineCut cut;
  double gain = 0;     // gain of log det over the current cut; 0 if that is kept
  int iterations = 0;  // iterations of the three ascents together
};
SingleLineCut CutSingleLine(const CuttingProblem& problem,
                            std::size_t line,
                            const InformationSums& rest,
                            const LineCut& present,
                            CuttingInformation information);

}  // namespace plumbline
