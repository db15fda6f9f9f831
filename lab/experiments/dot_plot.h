// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/table.h"
#include "plumbline/report/figure.h"

#include <cstddef>

namespace plumbline {

// A plot of one column of a table: a band for each sequence, with a dot at the median and a bar
// over the range of the runs for each variant. The axis begins at 0, or is logarithmic if the
// values span more than a factor of 30. Variants without a value are marked in words; an ATE has
// the coverage beside it if that is below 99 %.
Figure DotPlot(const Plan& plan, const ResultTable& table, std::size_t column);

}  // namespace plumbline
