// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/results.h"

#include "plumbline/base/error.h"

#include <algorithm>

namespace plumbline {

std::vector<const Metric*> MetricsOf(const Experiment& experiment, MetricKind kind) {
  std::vector<const Metric*> metrics;
  const auto add = [&](const std::string& name) {
    const Metric* metric = FindMetric(name);
    PLUMBLINE_CHECK(metric != nullptr, "no metric is called " + name);
    if (metric->timing != (kind == MetricKind::kTiming)) return;
    if (std::find(metrics.begin(), metrics.end(), metric) == metrics.end()) {
      metrics.push_back(metric);
    }
  };
  for (const auto* names : {&experiment.metrics, &experiment.plots}) {
    for (const std::string& name : *names) {
      add(name);
      if (name.starts_with("ate")) add("coverage");
    }
  }
  return metrics;
}

std::vector<ResultRow> CollectResults(const Plan& plan,
                                      const std::vector<JobResult>& results,
                                      MetricKind kind) {
  std::vector<ResultRow> rows;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    const Job& job = plan.jobs[i];
    for (const Metric* metric : MetricsOf(plan.experiment, kind)) {
      ResultRow row{plan.SequenceOf(job).name, plan.VariantOf(job).name, job.run, metric, {}, {}};
      const auto& figures = results[i].figures;
      if (!figures) {
        row.reason = results[i].reason;
      } else if (const auto value = figures->values.find(metric->name);
                 value != figures->values.end()) {
        row.value = value->second;
      } else {
        const auto reason = figures->reasons.find(metric->name);
        row.reason = reason == figures->reasons.end() ? "not measured" : reason->second;
      }
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

std::string FormatResults(const std::string& experiment,
                          const std::vector<ResultRow>& rows,
                          const std::vector<FigureRow>& over_runs) {
  std::vector<FigureRow> figures;
  figures.reserve(rows.size());
  for (const ResultRow& row : rows) {
    figures.push_back({row.sequence,
                       row.variant,
                       row.seed,
                       std::string(row.metric->name),
                       row.value,
                       std::string(row.metric->unit),
                       row.reason});
  }
  figures.insert(figures.end(), over_runs.begin(), over_runs.end());
  return FormatFigureList(experiment, figures);
}

}  // namespace plumbline
