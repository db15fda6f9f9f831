// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/report/figure.h"

#include <string>
#include <vector>

namespace plumbline {

struct Box {
  std::string name;
  std::vector<double> values;
};

// For each group of values, from top to bottom: a box from the first to the third quartile with the
// median across it, and a line from the least to the greatest value. Groups without values are left
// out. The axis spans all values.
Figure BoxPlot(const std::string& label, const std::vector<Box>& boxes);

}  // namespace plumbline
