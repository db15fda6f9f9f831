// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/paired_ratios.h"

#include "lab/experiments/mean.h"
#include "plumbline/base/elementary.h"
#include "plumbline/base/random.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

constexpr int kSamples = 2000;
constexpr double kCoverageGap = 1;  // percent

// Results by sequence, run and variant.
using Runs = std::map<std::pair<std::size_t, int>, std::map<std::size_t, const JobResult*>>;

Runs RunsOf(const Plan& plan, const std::vector<JobResult>& results) {
  Runs runs;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    const Job& job = plan.jobs[i];
    runs[{job.sequence, job.run}][job.variant] = &results[i];
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

// The mean over sequences of the means over their pairs.
double MeanOfMeans(const std::vector<std::vector<double>>& sequences) {
  std::vector<double> means;
  for (const auto& pairs : sequences) means.push_back(Mean(pairs));
  return Mean(means);
}

template <class T>
std::vector<T> Resample(const std::vector<T>& values, Rng& rng) {
  std::vector<T> sample;
  for (std::size_t i = 0; i < values.size(); ++i)
    sample.push_back(values[rng.Index(values.size())]);
  return sample;
}

// Sets ratio and interval from the logarithms of each sequence.
void SetRatio(const std::vector<std::vector<double>>& logs,
              const std::string& stream,
              PairedRatio& out) {
  if (logs.empty()) return;
  out.ratio = math::Exp(MeanOfMeans(logs));
  std::vector<double> samples;
  for (int i = 0; i < kSamples; ++i) {
    Rng rng(0, stream, static_cast<std::uint64_t>(i));
    std::vector<std::vector<double>> sample = Resample(logs, rng);
    for (auto& pairs : sample) pairs = Resample(pairs, rng);
    samples.push_back(math::Exp(MeanOfMeans(sample)));
  }
  std::sort(samples.begin(), samples.end());
  out.low = samples[kSamples * 25 / 1000];
  out.high = samples[kSamples * 975 / 1000 - 1];
}

// The pairs of one variant on one sequence.
struct SequencePairs {
  std::vector<double> logs;
  int left_out = 0;
  int lost_alone = 0;
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
    const bool another_holds = std::any_of(by_variant.begin(),
                                           by_variant.end(),
                                           [](const auto& other) { return !Lost(*other.second); });
    if (another_holds && Lost(*mine->second)) ++out.lost_alone;
    const auto other = by_variant.find(reference);
    if (other == by_variant.end()) continue;
    const auto log = LogRatio(*mine->second, *other->second, metric);
    if (!log) {
      ++out.left_out;
    } else if (seen.insert({mine->second->figures->trajectory, other->second->figures->trajectory})
                   .second) {
      out.logs.push_back(*log);
    }
  }
  return out;
}

// The ratios of every variant in one metric: by sequence, then over all of them.
std::vector<PairedRatio> RatiosOf(const Plan& plan,
                                  const Runs& runs,
                                  std::size_t reference,
                                  const std::string& metric) {
  const auto& variants = plan.experiment.variants;
  std::vector<PairedRatio> ratios;
  for (std::size_t v = 0; v < variants.size(); ++v) {
    PairedRatio all;
    all.variant = v;
    all.metric = metric;
    std::vector<std::vector<double>> logs;
    for (std::size_t s = 0; s < plan.sequences.size(); ++s) {
      const SequencePairs pairs = PairsOf(runs, s, v, reference, metric);
      PairedRatio one{s, v, static_cast<int>(pairs.logs.size()), pairs.left_out};
      one.lost_alone = pairs.lost_alone;
      one.metric = metric;
      all.pairs += one.pairs;
      all.left_out += one.left_out;
      all.lost_alone += one.lost_alone;
      if (!pairs.logs.empty()) {
        SetRatio({pairs.logs}, plan.sequences[s].name + "/" + variants[v].name, one);
        logs.push_back(pairs.logs);
      }
      if (one.pairs + one.left_out + one.lost_alone > 0) ratios.push_back(one);
    }
    SetRatio(logs, variants[v].name, all);
    if (all.pairs + all.left_out + all.lost_alone > 0) ratios.push_back(all);
  }
  return ratios;
}

}  // namespace

std::vector<PairedRatio> PairedRatios(const Plan& plan, const std::vector<JobResult>& results) {
  const auto& variants = plan.experiment.variants;
  const auto named = std::find_if(variants.begin(), variants.end(), [&](const Variant& v) {
    return v.name == plan.experiment.reference;
  });
  if (named == variants.end()) return {};
  const auto reference = static_cast<std::size_t>(named - variants.begin());
  if (std::none_of(plan.jobs.begin(), plan.jobs.end(), [&](const Job& job) {
        return job.variant == reference;
      })) {
    return {};
  }
  const Runs runs = RunsOf(plan, results);
  std::vector<PairedRatio> ratios;
  for (const std::string& metric : plan.experiment.ratios) {
    const std::vector<PairedRatio> of_metric = RatiosOf(plan, runs, reference, metric);
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

std::string RatioText(const PairedRatio& ratio) {
  if (ratio.pairs == 0) return "-";
  return fmt::format("{:.3f} ({:.3f}-{:.3f})", ratio.ratio, ratio.low, ratio.high);
}

std::string FormatRatioList(const Plan& plan, const std::vector<PairedRatio>& ratios) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const PairedRatio& r : ratios) {
    nlohmann::ordered_json entry;
    entry["metric"] = r.metric;
    entry["variant"] = plan.experiment.variants[r.variant].name;
    entry["sequence"] = nullptr;
    if (r.sequence) entry["sequence"] = plan.sequences[*r.sequence].name;
    entry["pairs"] = r.pairs;
    entry["left_out"] = r.left_out;
    entry["lost_alone"] = r.lost_alone;
    for (const auto& [name, value] :
         {std::pair{"ratio", r.ratio}, std::pair{"low", r.low}, std::pair{"high", r.high}}) {
      entry[name] = nullptr;
      if (r.pairs > 0) entry[name] = std::round(value * 1e4) / 1e4;
    }
    list.push_back(entry);
  }
  return list.dump(1) + "\n";
}

std::string FormatRatios(const Plan& plan, const std::vector<PairedRatio>& ratios) {
  std::string text;
  for (const std::vector<PairedRatio>& of_metric : ByMetric(ratios)) {
    text += fmt::format(
        "\n## {}\n\nGeometric mean over runs of the error divided by that of {} in the same run of "
        "the same sequence, with 95 % bootstrap intervals; over all sequences each counts the "
        "same. "
        "Lost alone: runs with lost frames where another variant lost none.\n\n"
        "| variant | sequence | pairs | ratio | left out | lost alone "
        "|\n|---|---|---|---|---|---|\n",
        RatioTitle(plan, of_metric.front().metric),
        plan.experiment.reference);
    for (const PairedRatio& r : of_metric) {
      text += fmt::format("| {} | {} | {} | {} | {} | {} |\n",
                          plan.experiment.variants[r.variant].name,
                          r.sequence ? plan.sequences[*r.sequence].name : "**all**",
                          r.pairs,
                          RatioText(r),
                          r.left_out,
                          r.lost_alone);
    }
  }
  return text;
}

}  // namespace plumbline
