// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/paired_ratios.h"

#include "lab/experiments/mean.h"
#include "plumbline/base/elementary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include <boost/math/distributions/students_t.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

constexpr double kCoverageGap = 1;  // percent
constexpr double kConfidence = 0.95;

// Places that several sequences show: the beginning of their names.
constexpr std::array<std::string_view, 6> kPlaces = {
    "worlds/vicon", "euroc/V1", "euroc/V2", "euroc/MH", "icl/living_room", "icl/office"};

struct RunResult {
  const JobResult* job = nullptr;
  const std::vector<StartRecord>* starts = nullptr;  // null: of another kind of experiment
};

// Results by sequence, run and variant.
using Runs = std::map<std::pair<std::size_t, int>, std::map<std::size_t, RunResult>>;

Runs RunsOf(const Plan& plan, const std::vector<JobResult>& results, const StartsByJob& starts) {
  Runs runs;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    const Job& job = plan.jobs[i];
    runs[{job.sequence, job.run}][job.variant] = {&results[i],
                                                  starts.empty() ? nullptr : &starts[i]};
  }
  return runs;
}

std::optional<double> ValueOf(const JobResult& result, std::string_view metric) {
  if (!result.figures) return std::nullopt;
  const auto value = result.figures->values.find(metric);
  return value == result.figures->values.end() ? std::nullopt : std::optional(value->second);
}

bool Lost(const JobResult& result) { return ValueOf(result, "lost").value_or(1) > 0; }

// The logarithm of the ratio of a pair that can be compared.
std::optional<double> LogRatio(const JobResult& variant,
                               const JobResult& reference,
                               std::string_view metric) {
  const auto a = ValueOf(variant, metric);
  const auto b = ValueOf(reference, metric);
  const double covered_a = ValueOf(variant, "coverage").value_or(0);
  const double covered_b = ValueOf(reference, "coverage").value_or(0);
  if (!a || !b || !(*a > 0) || !(*b > 0)) return std::nullopt;
  if (std::abs(covered_a - covered_b) > kCoverageGap) return std::nullopt;
  return math::Log(*a / *b);
}

// Sets ratio and interval from logarithms that are independent of each other.
void SetRatio(const std::vector<double>& logs, PairedRatio& out) {
  if (logs.empty()) return;
  const double mean = Mean(logs);
  out.ratio = math::Exp(mean);
  if (const auto half = HalfWidthOfMean(logs)) {
    out.low = math::Exp(mean - *half);
    out.high = math::Exp(mean + *half);
  }
}

// A number of the map of one start; nullopt if it is unknown, or the metric is not of this kind.
std::optional<double> StartFigure(const StartRecord& start, std::string_view metric) {
  if (!start.map) return std::nullopt;
  const StartErrors& errors = start.map->errors;
  if (metric == "rotation_error") return errors.rotation_deg;
  if (metric == "direction_error") return errors.direction_deg;
  if (metric == "depth_error") return errors.depth;
  if (metric == "map_seconds") return start.map->seconds;
  if (metric == "map_parallax") return start.map->parallax_deg;
  return std::nullopt;
}

// The logarithm of the ratio of two starts at one first frame; nullopt if one is not right, or
// their reference frames differ.
std::optional<double> StartLog(const StartRecord& start,
                               const StartRecord& reference,
                               std::string_view metric) {
  constexpr StartOutcome kRight = StartOutcome::kRight;
  if (start.outcome != kRight || reference.outcome != kRight) return std::nullopt;
  if (start.map->reference != reference.map->reference) return std::nullopt;
  const auto mine = StartFigure(start, metric);
  const auto other = StartFigure(reference, metric);
  if (!mine || !other) return std::nullopt;
  const double ratio = *mine / *other;
  return ratio > 0 && std::isfinite(ratio) ? std::optional(math::Log(ratio)) : std::nullopt;
}

// The pairs of one variant on one sequence.
struct SequencePairs {
  std::vector<double> logs;
  int left_out = 0;
  int lost_alone = 0;

  void Add(const std::optional<double>& log) {
    if (log) {
      logs.push_back(*log);
    } else {
      ++left_out;
    }
  }
};

SequencePairs PairsOf(const Runs& runs,
                      std::size_t sequence,
                      std::size_t variant,
                      std::size_t reference,
                      std::string_view metric) {
  SequencePairs out;
  std::set<std::pair<std::string, std::string>> seen;
  for (const auto& [key, by_variant] : runs) {
    if (key.first != sequence) continue;
    const auto mine = by_variant.find(variant);
    if (mine == by_variant.end()) continue;
    const bool another_holds =
        std::any_of(by_variant.begin(), by_variant.end(), [](const auto& other) {
          return !Lost(*other.second.job);
        });
    if (another_holds && Lost(*mine->second.job)) ++out.lost_alone;
    const auto other = by_variant.find(reference);
    if (other == by_variant.end()) continue;
    if (mine->second.starts != nullptr) {
      for (const auto& [start, of_reference] :
           CommonStarts(*mine->second.starts, *other->second.starts)) {
        out.Add(StartLog(*start, *of_reference, metric));
      }
      continue;
    }
    const JobResult& a = *mine->second.job;
    const JobResult& b = *other->second.job;
    const auto log = LogRatio(a, b, metric);
    if (!log) {
      ++out.left_out;
    } else if (seen.insert({a.figures->trajectory, b.figures->trajectory}).second) {
      out.logs.push_back(*log);
    }
  }
  return out;
}

// The ratios of every variant in one metric: by sequence, then over all of them.
std::vector<PairedRatio> RatiosOf(const Plan& plan, const Runs& runs, const std::string& metric) {
  std::vector<PairedRatio> ratios;
  for (std::size_t v = 0; v < plan.experiment.variants.size(); ++v) {
    const auto reference = ReferenceOf(plan, v);
    if (!reference) continue;
    PairedRatio all;
    all.variant = v;
    all.metric = metric;
    std::map<std::string, std::vector<double>> places;  // mean logarithms of the sequences
    for (std::size_t s = 0; s < plan.sequences.size(); ++s) {
      const SequencePairs pairs = PairsOf(runs, s, v, *reference, metric);
      PairedRatio one{s, v, static_cast<int>(pairs.logs.size()), pairs.left_out};
      one.lost_alone = pairs.lost_alone;
      one.metric = metric;
      all.pairs += one.pairs;
      all.left_out += one.left_out;
      all.lost_alone += one.lost_alone;
      if (!pairs.logs.empty()) {
        SetRatio(pairs.logs, one);
        places[PlaceOf(plan.sequences[s].name)].push_back(Mean(pairs.logs));
      }
      if (one.pairs + one.left_out + one.lost_alone > 0) ratios.push_back(one);
    }
    std::vector<double> means;
    for (const auto& [place, logs] : places) means.push_back(Mean(logs));
    SetRatio(means, all);
    all.places = static_cast<int>(means.size());
    if (all.pairs + all.left_out + all.lost_alone > 0) ratios.push_back(all);
  }
  return ratios;
}

}  // namespace

std::string PlaceOf(const std::string& sequence) {
  for (const std::string_view place : kPlaces) {
    if (sequence.starts_with(place)) return std::string(place);
  }
  std::string name = sequence.substr(0, sequence.find('@'));
  return name.substr(0, name.find("_first"));
}

std::optional<double> HalfWidthOfMean(const std::vector<double>& values) {
  if (values.size() < 2) return std::nullopt;
  const auto n = static_cast<double>(values.size());
  const double mean = Mean(values);
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const boost::math::students_t distribution(n - 1);
  return boost::math::quantile(distribution, 0.5 * (1 + kConfidence)) *
         std::sqrt(squares / (n - 1) / n);
}

std::optional<std::size_t> ReferenceOf(const Plan& plan, std::size_t variant) {
  const auto& variants = plan.experiment.variants;
  const std::string& own = variants[variant].reference;
  const std::string& name = own.empty() ? plan.experiment.reference : own;
  const auto named = std::find_if(
      variants.begin(), variants.end(), [&](const Variant& v) { return v.name == name; });
  const auto reference = static_cast<std::size_t>(named - variants.begin());
  const bool is_run = std::any_of(
      plan.jobs.begin(), plan.jobs.end(), [&](const Job& job) { return job.variant == reference; });
  return is_run ? std::optional(reference) : std::nullopt;
}

std::string ComparedName(const Plan& plan, std::size_t variant) {
  const Variant& v = plan.experiment.variants[variant];
  return v.reference.empty() ? v.name : v.name + " / " + v.reference;
}

std::vector<PairedRatio> PairedRatios(const Plan& plan,
                                      const std::vector<JobResult>& results,
                                      const StartsByJob& starts) {
  const Runs runs = RunsOf(plan, results, starts);
  std::vector<PairedRatio> ratios;
  for (const std::string& metric : plan.experiment.ratios) {
    const std::vector<PairedRatio> of_metric = RatiosOf(plan, runs, metric);
    ratios.insert(ratios.end(), of_metric.begin(), of_metric.end());
  }
  return ratios;
}

std::vector<std::vector<PairedRatio>> ByMetric(const std::vector<PairedRatio>& ratios) {
  std::vector<std::vector<PairedRatio>> parts;
  for (const PairedRatio& ratio : ratios) {
    if (parts.empty() || parts.back().back().metric != ratio.metric) parts.emplace_back();
    parts.back().push_back(ratio);
  }
  return parts;
}

std::string RatioTitle(const Plan& plan, const std::string& metric) {
  return fmt::format("{} against {}", metric == "ate" ? "ATE" : metric, plan.experiment.reference);
}

std::string RatioNote(const Plan& plan) {
  if (plan.experiment.command == RunCommandKind::kStarts) {
    return fmt::format(
        "Geometric mean over the starts at the same first frame that both made right of the figure "
        "divided by that of {}, or of the variant behind the stroke, with 95 % intervals by "
        "Student's t; over all, each place counts the same. Left out: starts that not both made "
        "right, or not from one reference frame.",
        plan.experiment.reference);
  }
  return fmt::format(
      "Geometric mean over runs of the error divided by that of {} in the same run of the same "
      "sequence, with 95 % intervals by Student's t; over all, each place counts the same. Lost "
      "alone: runs with lost frames where another variant lost none.",
      plan.experiment.reference);
}

std::string RatioText(const PairedRatio& ratio) {
  if (ratio.pairs == 0) return "-";
  if (!ratio.low) return fmt::format("{:.3f}", ratio.ratio);
  return fmt::format("{:.3f} ({:.3f}-{:.3f})", ratio.ratio, *ratio.low, *ratio.high);
}

std::string VerdictText(const PairedRatio& ratio) {
  if (!ratio.low) return "-";
  if (*ratio.high < 1) return "better";
  if (*ratio.low > 1) return "worse";
  return fmt::format(
      "not told apart; below {:.2f} and above {:.2f} excluded", *ratio.low, *ratio.high);
}

std::string ChanceText(const Plan& plan, const std::vector<PairedRatio>& of_metric) {
  const auto comparisons = std::count_if(of_metric.begin(), of_metric.end(), [&](const auto& r) {
    return !r.sequence && r.low && ReferenceOf(plan, r.variant) != r.variant;
  });
  return fmt::format(
      "Of {} comparisons over all places, {:.1f} would seem certain by chance alone.",
      comparisons,
      (1 - kConfidence) * static_cast<double>(comparisons));
}

std::string FormatRatioList(const Plan& plan, const std::vector<PairedRatio>& ratios) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const PairedRatio& r : ratios) {
    nlohmann::ordered_json entry;
    entry["metric"] = r.metric;
    entry["variant"] = plan.experiment.variants[r.variant].name;
    entry["reference"] = plan.experiment.reference;
    if (const auto v = ReferenceOf(plan, r.variant)) {
      entry["reference"] = plan.experiment.variants[*v].name;
    }
    entry["sequence"] = nullptr;
    if (r.sequence) entry["sequence"] = plan.sequences[*r.sequence].name;
    entry["pairs"] = r.pairs;
    if (!r.sequence) entry["places"] = r.places;
    entry["left_out"] = r.left_out;
    entry["lost_alone"] = r.lost_alone;
    const std::optional<double> ratio = r.pairs > 0 ? std::optional(r.ratio) : std::nullopt;
    for (const auto& [name, value] :
         {std::pair{"ratio", ratio}, std::pair{"low", r.low}, std::pair{"high", r.high}}) {
      entry[name] = nullptr;
      if (value) entry[name] = std::round(*value * 1e4) / 1e4;
    }
    list.push_back(entry);
  }
  return list.dump(1) + "\n";
}

std::string FormatRatios(const Plan& plan, const std::vector<PairedRatio>& ratios) {
  std::string text;
  for (const std::vector<PairedRatio>& of_metric : ByMetric(ratios)) {
    text += fmt::format(
        "\n## {}\n\n{} {}\n\n| variant | sequence | pairs | ratio | | left out | lost alone "
        "|\n|---|---|---|---|---|---|---|\n",
        RatioTitle(plan, of_metric.front().metric),
        RatioNote(plan),
        ChanceText(plan, of_metric));
    for (const PairedRatio& r : of_metric) {
      text += fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n",
                          ComparedName(plan, r.variant),
                          r.sequence ? plan.sequences[*r.sequence].name
                                     : fmt::format("**all {} places**", r.places),
                          r.pairs,
                          RatioText(r),
                          VerdictText(r),
                          r.left_out,
                          r.lost_alone);
    }
  }
  return text;
}

}  // namespace plumbline
