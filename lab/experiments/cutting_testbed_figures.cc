// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/cutting_testbed_figures.h"

#include "lab/experiments/mean.h"
#include "plumbline/base/elementary.h"
#include "plumbline/base/options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include <fmt/format.h>

namespace plumbline {
namespace {

constexpr std::array kMetrics = {
    FigureMetric{"cases", "", "lines, scenes or poses that were tried", 0},
    FigureMetric{"share_within_0.01_of_brute_force",
                 "%",
                 "gradient ascent of a single line against a grid of step 0.01: both ratios within "
                 "0.01, or log det at most 1e-3 below",
                 2},
    FigureMetric{"share_ratios_within_0.01", "%", "the same by the ratios alone", 2},
    FigureMetric{
        "worst_shortfall",
        "",
        "greatest log det below the best known (single: the grid's best, negative where the "
        "ascent is always above it)",
        4},
    FigureMetric{"share_full_length", "%", "lines whose best cut by the grid is none", 1},
    FigureMetric{"share_point", "%", "lines whose best cut by the grid is a point", 1},
    FigureMetric{
        "mean_gain", "", "rise of log det over full length (choice: over random), mean", 4},
    FigureMetric{"mean_shortfall", "", "log det below the best known, mean", 5},
    FigureMetric{
        "share_within_0.01_of_best", "%", "scenes with log det at most 0.01 below that", 1},
    FigureMetric{"translation_error_median", "mm", "of the pose, median", 1},
    FigureMetric{"translation_error_p90", "mm", "of the pose, 90 % quantile", 1},
    FigureMetric{"rotation_error_median", "deg", "of the pose, median", 3},
    FigureMetric{"motion_error",
                 "mm",
                 "stereo: error of the motion along itself, mean; below 0 where less is found",
                 1},
    FigureMetric{"translation_ratio",
                 "",
                 "error over that of whole lines without weights in the same scene, geometric mean",
                 3},
    FigureMetric{"translation_ratio_low", "", "lower end of its 95 % interval", 3},
    FigureMetric{"translation_ratio_high", "", "upper end of its 95 % interval", 3},
    FigureMetric{"time_median", "us", "of one scene by the clock, median", 1},
};

const FigureMetric& Metric(std::string_view name) {
  return *std::find_if(
      kMetrics.begin(), kMetrics.end(), [&](const FigureMetric& m) { return m.name == name; });
}

FigureRow Row(const std::string& sequence,
              const std::string& variant,
              std::string_view metric,
              double value) {
  return {sequence, variant, {}, std::string(metric), value, std::string(Metric(metric).unit)};
}

double Quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

// Percent of the elements with a property.
template <class T, class Predicate>
double Share(const std::vector<T>& list, const Predicate& has) {
  return 100.0 * static_cast<double>(std::count_if(list.begin(), list.end(), has)) /
         static_cast<double>(list.size());
}

template <class T>
using Groups = std::vector<std::pair<std::string, std::vector<T>>>;

template <class T>
void Append(Groups<T>& groups, const std::string& name, const std::vector<T>& more) {
  auto group = std::find_if(
      groups.begin(), groups.end(), [&](const auto& candidate) { return candidate.first == name; });
  if (group == groups.end()) group = groups.insert(groups.end(), {name, {}});
  group->second.insert(group->second.end(), more.begin(), more.end());
}

// The trials of each cell, then all of a kind and noise, then all together.
template <class T>
Groups<T> GroupTrials(const std::vector<const TrialCell<T>*>& cells) {
  Groups<T> groups;
  for (const auto* cell : cells) Append(groups, NameOf(cell->options), cell->trials);
  for (const auto* cell : cells) {
    const SceneOptions& options = cell->options;
    const std::string name = fmt::format("{}/{}/all", NameOf(options.kind), options.noise);
    Append(groups, name, cell->trials);
  }
  for (const auto* cell : cells) Append(groups, "all", cell->trials);
  return groups;
}
template <class T>
Groups<T> GroupTrials(const std::vector<TrialCell<T>>& cells) {
  std::vector<const TrialCell<T>*> pointers;
  for (const TrialCell<T>& cell : cells) pointers.push_back(&cell);
  return GroupTrials(pointers);
}

void AddSingle(const TestbedTrials& trials, std::vector<FigureRow>& rows) {
  std::map<std::string, std::vector<const TrialCell<SingleLineTrial>*>> by_variant;
  for (const SingleLineCell& cell : trials.single) {
    by_variant[NameOf(cell.information) + "+" + NameOf(cell.starts)].push_back(&cell);
  }
  for (const auto& [variant, cells] : by_variant) {
    for (const auto& [name, list] : GroupTrials(cells)) {
      const std::string sequence = "single/" + name;
      const auto add = [&](std::string_view metric, double value) {
        rows.push_back(Row(sequence, variant, metric, value));
      };
      double worst = list.front().shortfall;
      for (const SingleLineTrial& trial : list) worst = std::max(worst, trial.shortfall);
      add("cases", static_cast<double>(list.size()));
      add("share_within_0.01_of_brute_force", Share(list, [](auto& t) { return t.Agrees(); }));
      add("share_ratios_within_0.01", Share(list, [](auto& t) { return t.RatiosAgree(); }));
      add("worst_shortfall", worst);
      add("share_full_length",
          Share(list, [](auto& t) { return t.grid.x() == 0 && t.grid.y() == 1; }));
      add("share_point", Share(list, [](auto& t) { return t.grid.x() == t.grid.y(); }));
    }
  }
}

template <class Value>
std::vector<double> JointValues(const std::vector<JointTrial>& list, const Value& value) {
  std::vector<double> values;
  for (const JointTrial& trial : list) values.push_back(value(trial));
  return values;
}

void AddJoint(const TestbedTrials& trials, std::vector<FigureRow>& rows) {
  for (const auto& [name, list] : GroupTrials(trials.joint)) {
    for (const auto& [optimizer, variant] : EnumNames(std::type_identity<JointOptimizer>{})) {
      const auto add = [&, &group = name, &by = variant](std::string_view metric, double value) {
        rows.push_back(Row("joint/" + group, by, metric, value));
      };
      const auto gains = JointValues(list, [&, o = optimizer](const JointTrial& t) {
        return t.outcomes.at(o).log_determinant -
               t.outcomes.at(JointOptimizer::kFull).log_determinant;
      });
      const auto shortfalls = JointValues(list, [&, o = optimizer](const JointTrial& t) {
        return t.best - t.outcomes.at(o).log_determinant;
      });
      add("cases", static_cast<double>(list.size()));
      add("mean_gain", Mean(gains));
      add("mean_shortfall", Mean(shortfalls));
      add("worst_shortfall", Quantile(shortfalls, 1));
      add("share_within_0.01_of_best", Share(shortfalls, [](double s) { return s <= 0.01; }));
    }
  }
}

// Of the errors of one variant over those of whole lines without weights, each in the same scene.
struct GeometricMean {
  double mean = 1, low = 1, high = 1;
};
GeometricMean RatioToFull(const std::vector<PoseTrial>& list, PoseVariant variant) {
  std::vector<double> logs, squares;
  for (const PoseTrial& trial : list) {
    logs.push_back(
        math::Log(trial.at(variant).translation_m / trial.at(PoseVariant::kFull).translation_m));
    squares.push_back(logs.back() * logs.back());
  }
  const double mean = Mean(logs);
  const double variance = std::max(0.0, Mean(squares) - mean * mean);
  const double half = 1.96 * std::sqrt(variance / static_cast<double>(logs.size()));
  return {math::Exp(mean), math::Exp(mean - half), math::Exp(mean + half)};
}

template <class Value>
std::vector<double> PoseValues(const std::vector<PoseTrial>& list,
                               PoseVariant variant,
                               const Value& value) {
  std::vector<double> values;
  for (const PoseTrial& trial : list) values.push_back(value(trial.at(variant)));
  return values;
}

void AddPoses(const TestbedTrials& trials, std::vector<FigureRow>& rows) {
  for (const auto& [name, list] : GroupTrials(trials.poses)) {
    for (const auto& [variant, text] : EnumNames(std::type_identity<PoseVariant>{})) {
      const auto add = [&, &group = name, &by = text](std::string_view metric, double value) {
        rows.push_back(Row("pose/" + group, by, metric, value));
      };
      const auto translations =
          PoseValues(list, variant, [](const PoseError& e) { return 1000 * e.translation_m; });
      const auto rotations =
          PoseValues(list, variant, [](const PoseError& e) { return e.rotation_deg; });
      const auto motions =
          PoseValues(list, variant, [](const PoseError& e) { return 1000 * e.along_motion_m; });
      const GeometricMean ratio = RatioToFull(list, variant);
      add("cases", static_cast<double>(list.size()));
      add("translation_error_median", Quantile(translations, 0.5));
      add("translation_error_p90", Quantile(translations, 0.9));
      add("rotation_error_median", Quantile(rotations, 0.5));
      if (name.starts_with(NameOf(SceneKind::kStereo))) add("motion_error", Mean(motions));
      add("translation_ratio", ratio.mean);
      add("translation_ratio_low", ratio.low);
      add("translation_ratio_high", ratio.high);
    }
  }
}

void AddChoices(const TestbedTrials& trials, std::vector<FigureRow>& rows) {
  for (const auto& [options, list] : trials.choices) {
    const std::string sequence =
        fmt::format("choice/{}_of_{}+{}", options.budget, options.points, options.lines);
    for (const auto& [variant, name] : EnumNames(std::type_identity<ChoiceVariant>{})) {
      std::vector<double> gains, shortfalls;
      for (const ChoiceTrial& trial : list) {
        const double value = trial.log_determinant.at(variant);
        gains.push_back(value - trial.log_determinant.at(ChoiceVariant::kRandom));
        shortfalls.push_back(trial.best - value);
      }
      rows.push_back(Row(sequence, name, "cases", static_cast<double>(list.size())));
      rows.push_back(Row(sequence, name, "mean_gain", Mean(gains)));
      rows.push_back(Row(sequence, name, "mean_shortfall", Mean(shortfalls)));
      rows.push_back(Row(sequence, name, "worst_shortfall", Quantile(shortfalls, 1)));
    }
  }
}

}  // namespace

std::span<const FigureMetric> CuttingTestbedMetrics() { return kMetrics; }

std::vector<FigureRow> CuttingTestbedFigures(const TestbedTrials& trials) {
  std::vector<FigureRow> rows;
  AddSingle(trials, rows);
  AddJoint(trials, rows);
  AddPoses(trials, rows);
  AddChoices(trials, rows);
  return rows;
}

std::vector<FigureRow> CuttingTestbedTimes(const TestbedTrials& trials) {
  std::vector<FigureRow> rows;
  for (const auto& [name, list] : GroupTrials(trials.joint)) {
    for (const auto& [optimizer, variant] : EnumNames(std::type_identity<JointOptimizer>{})) {
      const auto times = JointValues(
          list, [o = optimizer](const JointTrial& t) { return t.outcomes.at(o).microseconds; });
      rows.push_back(Row("joint/" + name, variant, "time_median", Quantile(times, 0.5)));
    }
  }
  return rows;
}

}  // namespace plumbline
