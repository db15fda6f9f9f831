// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/paired_starts.h"

#include "lab/experiments/mean.h"
#include "lab/experiments/paired_ratios.h"
#include "lab/starts/start_figures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <boost/math/distributions/binomial.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumbline {
namespace {

constexpr double kPercent = 100;
constexpr const char* kAllPlaces = "all_places";

bool IsRight(const StartRecord& start) { return start.outcome == StartOutcome::kRight; }

void Count(const StartRecord& start, const StartRecord& reference, PairedStarts& out) {
  ++out.starts;
  out.wrong += start.outcome == StartOutcome::kWrong;
  if (!IsPossible(start).value_or(true)) return;
  ++out.possible;
  out.right += IsRight(start);
  out.late += start.outcome == StartOutcome::kLate;
  out.waiting += start.outcome == StartOutcome::kWaiting;
  out.right_alone += IsRight(start) && !IsRight(reference);
  out.reference_alone += IsRight(reference) && !IsRight(start);
}

void Add(const PairedStarts& one, PairedStarts& all) {
  all.starts += one.starts;
  all.possible += one.possible;
  all.right += one.right;
  all.late += one.late;
  all.waiting += one.waiting;
  all.wrong += one.wrong;
  all.right_alone += one.right_alone;
  all.reference_alone += one.reference_alone;
}

// The starts of one variant and its reference on one sequence, all runs.
PairedStarts PairsOf(const Plan& plan,
                     const StartsByJob& starts,
                     std::size_t sequence,
                     std::size_t variant,
                     std::size_t reference) {
  PairedStarts out;
  out.sequence = sequence;
  out.variant = variant;
  for (std::size_t a = 0; a < plan.jobs.size(); ++a) {
    if (plan.jobs[a].sequence != sequence || plan.jobs[a].variant != variant) continue;
    for (std::size_t b = 0; b < plan.jobs.size(); ++b) {
      const Job& other = plan.jobs[b];
      if (other.sequence != sequence || other.variant != reference) continue;
      if (other.run != plan.jobs[a].run) continue;
      for (const auto& [start, of_reference] : CommonStarts(starts[a], starts[b])) {
        Count(*start, *of_reference, out);
      }
    }
  }
  out.p = SignTestP(out.right_alone, out.reference_alone);
  if (out.possible > 0) {
    out.gain = kPercent * (out.right_alone - out.reference_alone) / out.possible;
  }
  return out;
}

void SetGain(const std::map<std::string, std::vector<double>>& gains_of_places, PairedStarts& all) {
  std::vector<double> gains;
  for (const auto& [place, of_place] : gains_of_places) gains.push_back(Mean(of_place));
  all.places = static_cast<int>(gains.size());
  if (gains.empty()) return;
  all.gain = Mean(gains);
  if (const auto half = HalfWidthOfMean(gains)) {
    all.gain_low = *all.gain - *half;
    all.gain_high = *all.gain + *half;
  }
}

std::string GainText(const PairedStarts& pairs) {
  if (!pairs.gain) return "-";
  if (!pairs.gain_low) return fmt::format("{:+.1f}", *pairs.gain);
  return fmt::format(
      "{:+.1f} ({:+.1f} to {:+.1f})", *pairs.gain, *pairs.gain_low, *pairs.gain_high);
}

}  // namespace

double SignTestP(int a, int b) {
  if (a + b == 0) return 1;
  const boost::math::binomial_distribution<double> chance(a + b, 0.5);
  return std::min(1.0, 2 * boost::math::cdf(chance, std::min(a, b)));
}

std::vector<PairedStarts> PairStarts(const Plan& plan, const StartsByJob& starts) {
  std::vector<PairedStarts> pairs;
  for (std::size_t v = 0; v < plan.experiment.variants.size(); ++v) {
    const auto reference = ReferenceOf(plan, v);
    if (!reference) continue;
    PairedStarts all;
    all.variant = v;
    std::map<std::string, std::vector<double>> gains;  // by place
    for (std::size_t s = 0; s < plan.sequences.size(); ++s) {
      const PairedStarts one = PairsOf(plan, starts, s, v, *reference);
      if (one.starts == 0) continue;
      Add(one, all);
      if (one.gain) gains[PlaceOf(plan.sequences[s].name)].push_back(*one.gain);
      pairs.push_back(one);
    }
    if (all.starts == 0) continue;
    all.p = SignTestP(all.right_alone, all.reference_alone);
    SetGain(gains, all);
    pairs.push_back(all);
  }
  return pairs;
}

std::vector<FigureRow> FiguresOfPairs(const Plan& plan, const std::vector<PairedStarts>& pairs) {
  std::vector<FigureRow> rows;
  for (const PairedStarts& p : pairs) {
    const auto add = [&](const char* metric, double value, const char* unit = "") {
      rows.push_back({p.sequence ? plan.sequences[*p.sequence].name : kAllPlaces,
                      plan.experiment.variants[p.variant].name,
                      std::nullopt,
                      metric,
                      value,
                      unit});
    };
    if (!p.sequence) {
      add("right", p.right);
      add("possible_or_unknown", p.possible);
      add("late", p.late);
      add("waiting", p.waiting);
      add("wrong", p.wrong);
    }
    add("right_alone", p.right_alone);
    add("reference_right_alone", p.reference_alone);
    add("sign_test_p", std::round(1e4 * p.p) / 1e4);
    const auto tenths = [](double value) { return std::round(10 * value) / 10; };
    if (p.gain) add("gain", tenths(*p.gain), "%");
    if (p.gain_low) add("gain_low", tenths(*p.gain_low), "%");
    if (p.gain_high) add("gain_high", tenths(*p.gain_high), "%");
  }
  return rows;
}

std::vector<std::vector<std::string>> CellsOfPairs(const Plan& plan,
                                                   const std::vector<PairedStarts>& pairs) {
  std::vector<std::vector<std::string>> rows = {{"variant",
                                                 "sequence",
                                                 "right / possible",
                                                 "late",
                                                 "wrong",
                                                 "waiting",
                                                 "right alone",
                                                 "reference right alone",
                                                 "p",
                                                 "right, points of %"}};
  for (const PairedStarts& p : pairs) {
    rows.push_back(
        {ComparedName(plan, p.variant),
         p.sequence ? plan.sequences[*p.sequence].name : fmt::format("all {} places", p.places),
         fmt::format("{} / {}", p.right, p.possible),
         std::to_string(p.late),
         std::to_string(p.wrong),
         std::to_string(p.waiting),
         std::to_string(p.right_alone),
         std::to_string(p.reference_alone),
         fmt::format("{:.3g}", p.p),
         GainText(p)});
  }
  return rows;
}

std::string PairsNote() {
  return "Starts at the same first frame, of a variant and of its reference. Right alone: in time "
         "and within all limits where the reference is not; p: of the exact sign test of the two "
         "columns before it, which takes starts for independent; points: by how much more starts "
         "are right than with the reference, over all with a 95 % interval by Student's t over "
         "places. Possible are starts that are not known to be impossible.";
}

std::string FormatPairs(const Plan& plan, const std::vector<PairedStarts>& pairs) {
  if (pairs.empty()) return "";
  const auto rows = CellsOfPairs(plan, pairs);
  std::string text = fmt::format("\n## Starts against {}, start by start\n\n{}\n\n| {} |\n",
                                 plan.experiment.reference,
                                 PairsNote(),
                                 fmt::join(rows.front(), " | "));
  for (std::size_t i = 0; i < rows.front().size(); ++i) text += "|---";
  text += "|\n";
  for (std::size_t i = 1; i < rows.size(); ++i) {
    text += fmt::format("| {} |\n", fmt::join(rows[i], " | "));
  }
  return text;
}

}  // namespace plumbline
