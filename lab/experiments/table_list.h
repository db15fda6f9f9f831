// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/paper_comparison.h"
#include "lab/experiments/plan.h"
#include "lab/experiments/table.h"

#include <string>

namespace plumbline {

// A table for other programs, as JSON; tools/results.py makes the documents' tables from it:
//
//   "help", "centre"  the experiment's purpose; "mean" or "median" over the counted runs
//   "columns"         {"metric", "title"} of each
//   "rows"            {"sequence", "variant", "runs", "cells"}: RunsText, and CellText by column
//   "printed"         {"metric", "title", "note", "header", "rows"} of each printed table with our
//                     figures beside it (ComparedTable)
//   "missing"         missing sequences (Plan::missing)
//   "failures"        FailureTexts
std::string FormatTableList(const Plan& plan,
                            const ResultTable& table,
                            const PaperComparison& comparison);

}  // namespace plumbline
