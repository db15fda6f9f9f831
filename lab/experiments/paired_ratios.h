// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/job_runner.h"
#include "lab/experiments/plan.h"
#include "lab/experiments/start_pools.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// The errors of one variant divided by those of the reference variant, pair by pair.
struct PairedRatio {
  std::optional<std::size_t> sequence;  // in the plan; nullopt: all places, each with equal weight
  std::size_t variant = 0;
  int pairs = 0;     // pairs that count
  int left_out = 0;  // runs without both errors, or whose coverages differ by more than one percent
  double ratio = 1;  // geometric mean
  // 95 % interval of the ratio; nullopt with one pair, or one place, which has no spread.
  std::optional<double> low = std::nullopt, high = std::nullopt;
  int places = 0;  // over all: independent places (PlaceOf) with a pair
  // Runs in which this variant lost frames or failed and another variant did not.
  int lost_alone = 0;
  std::string metric = "ate";  // of metrics.h
};

// Returns the variant of comparison of another one: Variant::reference, or Experiment::reference;
// nullopt if there is none, or the plan leaves it out.
std::optional<std::size_t> ReferenceOf(const Plan& plan, std::size_t variant);

// Returns "no_factorization / triangulated"; only the name if the reference is that of the
// experiment.
std::string ComparedName(const Plan& plan, std::size_t variant);

// Returns the place of a sequence: sequences of one place are not independent of each other. It is
// the name without @label and _firstN, and without the part that distinguishes flights through one
// room: worlds/vicon_easy and worlds/vicon_medium are worlds/vicon, euroc/V1_01_easy and
// euroc/V1_03_difficult are euroc/V1.
std::string PlaceOf(const std::string& sequence);

// Returns the ratios of the errors in plan.experiment.ratios, of each variant to its reference
// (ReferenceOf): one metric after the other, by sequence and over all. Empty without a reference.
//
// Paired: the same run of the same sequence. Pairs of runs whose two trajectories both occurred
// before count once. If `starts` are given (RunCommandKind::kStarts), pairs are those at the same
// first frame of the same run that both variants made right, from the same reference frame; other
// starts tried by both are left out.
//
// The intervals are those of Student's t for the mean of the logarithms: by sequence of its pairs,
// over all of the places (the mean of a place is that of its sequences, that of a sequence is that
// of its pairs).
std::vector<PairedRatio> PairedRatios(const Plan& plan,
                                      const std::vector<JobResult>& results,
                                      const StartsByJob& starts = {});

// Returns the half width of the 95 % interval of the mean of values by Student's t; nullopt for
// fewer than two.
std::optional<double> HalfWidthOfMean(const std::vector<double>& values);

// Returns "0.970 (0.930-1.020)"; without the parentheses if there is no interval; "-" without a
// pair.
std::string RatioText(const PairedRatio& ratio);

// Returns the conclusion from the interval of a ratio: "better", "worse", or "not told apart; below
// 0.93 and above 1.02 excluded".
std::string VerdictText(const PairedRatio& ratio);

// Returns a sentence: the number of comparisons over all that would appear certain by chance alone.
std::string ChanceText(const Plan& plan, const std::vector<PairedRatio>& of_metric);

// Groups ratios by metric, in their order.
std::vector<std::vector<PairedRatio>> ByMetric(const std::vector<PairedRatio>& ratios);

// Returns "ATE against plucker": the heading of the ratios of a metric.
std::string RatioTitle(const Plan& plan, const std::string& metric);
// Returns a sentence that defines the ratios.
std::string RatioNote(const Plan& plan);

// A JSON list of {"metric", "variant", "reference", "sequence" (null: all), "pairs", "places" (over
// all), "left_out", "lost_alone", "ratio", "low", "high"}; ratio is null without a pair, low and
// high without an interval.
std::string FormatRatioList(const Plan& plan, const std::vector<PairedRatio>& ratios);

// A section of a Markdown document for each metric; empty for no ratios.
std::string FormatRatios(const Plan& plan, const std::vector<PairedRatio>& ratios);

}  // namespace plumbline
