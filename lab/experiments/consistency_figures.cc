// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/consistency_figures.h"

#include "lab/consistency/consistency_report.h"
#include "lab/consistency/run_consistency.h"
#include "plumbline/base/error.h"

#include <algorithm>
#include <string_view>
#include <system_error>
#include <type_traits>

namespace plumbline {
namespace {

constexpr std::string_view kPrefix = "inside_";
constexpr std::size_t kLeastSamples = 200;

// Sets the reason of all these metrics, until a value replaces it.
void SayWhyNone(const std::string& reason, RunFigures& figures) {
  for (const Metric& metric : Metrics()) {
    if (metric.name.starts_with(kPrefix)) figures.reasons[std::string(metric.name)] = reason;
  }
}

void SetInside(const std::string& name, double share, RunFigures& figures) {
  constexpr double kPercent = 100;
  figures.values[name] = kPercent * share;
  figures.reasons.erase(name);
}

}  // namespace

void AddConsistencyFigures(const std::filesystem::path& sequence,
                           const std::filesystem::path& run,
                           RunFigures& figures) {
  std::error_code error;
  const bool known_world = std::filesystem::exists(sequence / "lines.csv", error);
  try {
    const auto samples = ReadRunConsistency(
        sequence, run, known_world ? ConsistencyPoses::kTruth : ConsistencyPoses::kRun);
    if (!samples) return SayWhyNone("no ground truth", figures);
    SayWhyNone("no such errors", figures);
    double least = 1, most = 0;
    for (const ConsistencyShare& share : ConsistencyShares(*samples)) {
      if (share.of == "all") SetInside(std::string(kPrefix) + share.kind, share.inside, figures);
      if (share.samples < kLeastSamples) continue;
      least = std::min(least, share.inside);
      most = std::max(most, share.inside);
    }
    if (most < least) return;
    SetInside("inside_least", least, figures);
    SetInside("inside_most", most, figures);
  } catch (const InputError&) {
    SayWhyNone("the run cannot be read", figures);
  }
}

bool AsksForConsistency(std::span<const std::string> metrics) {
  return std::any_of(metrics.begin(), metrics.end(), [](const std::string& name) {
    return name.starts_with(kPrefix);
  });
}

}  // namespace plumbline
