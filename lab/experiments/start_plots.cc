// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/start_plots.h"

#include "lab/experiments/curve_plot.h"
#include "lab/experiments/metrics.h"
#include "lab/starts/start_bench.h"
#include "lab/starts/start_figures.h"
#include "plumbline/report/figure.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Records = std::vector<StartRecord>;

constexpr double kPercent = 100;

// Steps from 0: the share of `total` with a value up to x, percent.
std::vector<Vector2d> Cumulative(std::vector<double> values, std::size_t total, double end) {
  std::sort(values.begin(), values.end());
  std::vector<Vector2d> steps;
  if (total == 0) return steps;
  double share = 0;
  steps.emplace_back(0, 0);
  for (std::size_t i = 0; i < values.size() && values[i] <= end; ++i) {
    steps.emplace_back(values[i], share);
    share = kPercent * static_cast<double>(i + 1) / static_cast<double>(total);
    steps.emplace_back(values[i], share);
  }
  steps.emplace_back(end, share);
  return steps;
}

// One panel for each pool that has starts, with a curve for each variant.
std::vector<CurvePanel> PanelsOfPools(
    const Plan& plan,
    const StartsByJob& starts,
    const CurvePanel& blank,
    const std::function<std::vector<Vector2d>(const Records&)>& curve) {
  std::vector<CurvePanel> panels;
  for (const SequencePool& pool : plan.experiment.pools) {
    CurvePanel panel = blank;
    panel.title = pool.name;
    for (std::size_t v = 0; v < plan.experiment.variants.size(); ++v) {
      panel.curves.push_back(
          {plan.experiment.variants[v].name, curve(StartsOfPool(plan, starts, pool, v))});
    }
    panels.push_back(std::move(panel));
  }
  return panels;
}

Figure TimePlot(const Plan& plan, const StartsByJob& starts) {
  const double end = StartPlan{}.patience;
  const CurvePanel blank{
      "", "seconds of video", "possible starts with a right map [%]", {}, false, end, kPercent};
  return CurvePlot(PanelsOfPools(plan, starts, blank, [end](const Records& records) {
    std::vector<double> seconds;
    std::size_t possible = 0;
    for (const StartRecord& record : records) {
      if (!IsPossible(record).value_or(false)) continue;
      ++possible;
      if (record.outcome == StartOutcome::kRight || record.outcome == StartOutcome::kLate) {
        seconds.push_back(record.map->seconds);
      }
    }
    return Cumulative(std::move(seconds), possible, end);
  }));
}

Figure ErrorPlot(const Plan& plan, const StartsByJob& starts) {
  struct Kind {
    const char* label;
    double end, factor;
    std::optional<double> StartErrors::*error;
  };
  std::vector<CurvePanel> panels;
  for (const Kind& kind : {Kind{"rotation error [deg]", 1, 1, &StartErrors::rotation_deg},
                           Kind{"direction error [deg]", 10, 1, &StartErrors::direction_deg},
                           Kind{"inverse depth error [%]", 20, kPercent, &StartErrors::depth}}) {
    const CurvePanel blank{"", kind.label, "maps [%]", {}, false, kind.end, kPercent};
    const auto more = PanelsOfPools(plan, starts, blank, [&kind](const Records& records) {
      std::vector<double> errors;
      for (const StartRecord& record : records) {
        if (!record.map) continue;
        if (const auto& error = record.map->errors.*kind.error) {
          errors.push_back(kind.factor * *error);
        }
      }
      const std::size_t count = errors.size();
      return Cumulative(std::move(errors), count, kind.end);
    });
    panels.insert(panels.end(), more.begin(), more.end());
  }
  return CurvePlot(panels);
}

// The curves of the variants, in the order of their first one.
std::vector<std::string> CurvesOf(const Plan& plan) {
  std::vector<std::string> names;
  for (const Variant& variant : plan.experiment.variants) {
    if (std::find(names.begin(), names.end(), variant.curve) == names.end()) {
      names.push_back(variant.curve);
    }
  }
  return names;
}

Figure AbscissaPlot(const Plan& plan, const StartsByJob& starts, const Metric& metric) {
  std::vector<CurvePanel> panels;
  for (const SequencePool& pool : plan.experiment.pools) {
    CurvePanel panel{pool.name, plan.experiment.abscissa, ColumnTitle(metric), {}, true, 0, 0};
    for (const std::string& name : CurvesOf(plan)) panel.curves.push_back({name, {}});
    for (std::size_t v = 0; v < plan.experiment.variants.size(); ++v) {
      const Variant& variant = plan.experiment.variants[v];
      const auto figures = FiguresOf(StartsOfPool(plan, starts, pool, v));
      const auto value = figures.find(metric.name);
      if (value == figures.end() || !std::isfinite(value->second)) continue;
      const auto curve = std::find_if(panel.curves.begin(),
                                      panel.curves.end(),
                                      [&](const Curve& c) { return c.name == variant.curve; });
      curve->points.emplace_back(variant.abscissa, value->second);
    }
    panels.push_back(std::move(panel));
  }
  return CurvePlot(panels);
}

}  // namespace

std::vector<PagePlot> StartPlots(const Plan& plan, const StartsByJob& starts) {
  if (plan.experiment.abscissa.empty()) {
    return {{"start_time", ToSvg(TimePlot(plan, starts))},
            {"start_errors", ToSvg(ErrorPlot(plan, starts))}};
  }
  std::vector<PagePlot> plots;
  for (const std::string& name : plan.experiment.plots) {
    plots.push_back({name, ToSvg(AbscissaPlot(plan, starts, *FindMetric(name)))});
  }
  return plots;
}

}  // namespace plumbline
