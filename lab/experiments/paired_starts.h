// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/figure_list.h"
#include "lab/experiments/plan.h"
#include "lab/experiments/start_pools.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// Comparison of the starts of a variant with those of its reference (ReferenceOf) at the same first
// frames of the same runs.
struct PairedStarts {
  std::optional<std::size_t> sequence;  // in the plan; nullopt: all
  std::size_t variant = 0;
  int starts = 0;    // tried by both
  int possible = 0;  // of these, those not known to be impossible (IsPossible)
  // Outcomes of the variant among the possible starts; wrong ones among all.
  int right = 0, late = 0, waiting = 0, wrong = 0;
  // Right ones not right for the reference, and the reverse.
  int right_alone = 0, reference_alone = 0;
  // P-value of the exact sign test: the probability that, by chance alone, those two differ at
  // least as much. The starts of a sequence count as independent, which neighbours are not quite: a
  // small value of one sequence alone is not conclusive.
  double p = 1;
  // Difference of the shares of right starts to the reference, percentage points; over all the mean
  // over places (PlaceOf), with its 95 % interval by Student's t.
  std::optional<double> gain{}, gain_low{}, gain_high{};
  int places = 0;  // over all: with a gain
};

// The two-sided p-value of the exact sign test for `a` pairs of one kind and `b` of the other
// (McNemar's test of discordant pairs); 1 without any.
double SignTestP(int a, int b);

// Returns the starts of each variant with a reference, and of the references: by sequence, then
// over all.
std::vector<PairedStarts> PairStarts(const Plan& plan, const StartsByJob& starts);

// Rows of the list of results: the metrics right_alone, reference_right_alone, sign_test_p, gain,
// gain_low, gain_high, and over all also right, possible_or_unknown, late, waiting, wrong. The
// sequence of the rows over all is "all_places"; there is no seed.
std::vector<FigureRow> FiguresOfPairs(const Plan& plan, const std::vector<PairedStarts>& pairs);

// A table of them: the rows of its cells, the first row being the headings of the columns.
std::vector<std::vector<std::string>> CellsOfPairs(const Plan& plan,
                                                   const std::vector<PairedStarts>& pairs);

// Returns the meaning of the columns, in one line.
std::string PairsNote();

// A section of a Markdown document; empty without pairs.
std::string FormatPairs(const Plan& plan, const std::vector<PairedStarts>& pairs);

}  // namespace plumbline
