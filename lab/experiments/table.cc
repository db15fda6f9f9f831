// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/table.h"

#include "plumbline/base/counted.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumbline {
namespace {

constexpr std::string_view kCoverage = "coverage";
constexpr double kCoverageGap = 1;  // percent of the frames that do not count

// The results of one variant on one sequence.
struct Group {
  std::size_t sequence = 0, variant = 0;
  std::vector<const JobResult*> runs;
};

std::vector<Group> GroupsOf(const Plan& plan, const std::vector<JobResult>& results) {
  std::vector<Group> groups;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    const Job& job = plan.jobs[i];
    if (groups.empty() || groups.back().sequence != job.sequence ||
        groups.back().variant != job.variant) {
      groups.push_back({job.sequence, job.variant, {}});
    }
    groups.back().runs.push_back(&results[i]);
  }
  return groups;
}

bool LostTheCamera(const RunFigures& run) {
  const auto coverage = run.values.find(kCoverage);
  return coverage == run.values.end() || coverage->second < 100 - kCoverageGap;
}

// Runs with a result; if failures are tolerated up to a limit, runs that lost the camera are
// failures too.
std::vector<const RunFigures*> WithResult(const Group& group, const Experiment& experiment) {
  std::vector<const RunFigures*> good;
  for (const JobResult* result : group.runs) {
    if (!result->figures) continue;
    if (experiment.tolerated_failures && LostTheCamera(*result->figures)) continue;
    good.push_back(&*result->figures);
  }
  return good;
}

// Of runs with the same trajectory the first.
std::vector<const RunFigures*> Distinct(const std::vector<const RunFigures*>& runs) {
  std::vector<const RunFigures*> distinct;
  std::set<std::string> trajectories;
  for (const RunFigures* run : runs) {
    if (trajectories.insert(run->trajectory).second) distinct.push_back(run);
  }
  return distinct;
}

TableCell MakeCell(const std::vector<const RunFigures*>& runs,
                   int failed,
                   std::string_view name,
                   Centre centre) {
  std::vector<double> values;
  for (const RunFigures* run : runs) {
    const auto value = run->values.find(name);
    if (value != run->values.end()) values.push_back(value->second);
  }
  TableCell cell;
  cell.missing = failed + static_cast<int>(runs.size() - values.size());
  cell.spread = SpreadOf(std::move(values), centre);
  return cell;
}

TableRow MakeRow(const Group& group, const ResultTable& table, const Experiment& experiment) {
  TableRow row;
  row.sequence = group.sequence;
  row.variant = group.variant;
  const auto good = WithResult(group, experiment), distinct = Distinct(good);
  row.runs = static_cast<int>(group.runs.size());
  row.failed = row.runs - static_cast<int>(good.size());
  row.same = static_cast<int>(good.size() - distinct.size());
  const auto& counted = table.kind == MetricKind::kTiming ? good : distinct;
  const bool reliable =
      !experiment.tolerated_failures || row.failed <= *experiment.tolerated_failures;
  for (const Metric* metric : table.columns) {
    row.cells.push_back(reliable ? MakeCell(counted, row.failed, metric->name, CentreOf(experiment))
                                 : TableCell{std::nullopt, row.runs, false});
  }
  const auto covered = MakeCell(distinct, 0, kCoverage, Centre::kMedian).spread;
  row.coverage = covered ? covered->centre : 0;
  return row;
}

std::string Number(double value, const Metric& metric) {
  return fmt::format("{:.{}f}", value, metric.digits);
}

// Marks the best of the rows [begin, end), all of one sequence, in a column.
void MarkBest(ResultTable& table, std::size_t column, std::pair<std::size_t, std::size_t> rows) {
  const Metric& metric = *table.columns[column];
  if (metric.better == Better::kNeither) return;
  const double sign = metric.better == Better::kLower ? 1 : -1;
  int least_missing = table.rows[rows.first].runs;
  double most_covered = 0;
  for (std::size_t r = rows.first; r < rows.second; ++r) {
    least_missing = std::min(least_missing, table.rows[r].cells[column].missing);
    most_covered = std::max(most_covered, table.rows[r].coverage);
  }
  std::vector<TableCell*> competing;
  std::set<std::string> printed;
  for (std::size_t r = rows.first; r < rows.second; ++r) {
    TableCell& cell = table.rows[r].cells[column];
    if (!cell.spread) continue;
    printed.insert(Number(cell.spread->centre, metric));
    if (cell.missing == least_missing && table.rows[r].coverage >= most_covered - kCoverageGap) {
      competing.push_back(&cell);
    }
  }
  if (competing.empty() || printed.size() < 2) return;
  const TableCell* best = *std::min_element(
      competing.begin(), competing.end(), [sign](const TableCell* a, const TableCell* b) {
        return sign * a->spread->centre < sign * b->spread->centre;
      });
  for (TableCell* cell : competing) {
    cell->best = Number(cell->spread->centre, metric) == Number(best->spread->centre, metric);
  }
}

void AddFailure(const Group& group, const std::string& reason, std::vector<Failure>& failures) {
  const auto same = std::find_if(failures.begin(), failures.end(), [&](const Failure& f) {
    return f.sequence == group.sequence && f.variant == group.variant && f.reason == reason;
  });
  if (same != failures.end()) {
    ++same->runs;
  } else {
    failures.push_back({group.sequence, group.variant, 1, reason});
  }
}

void AddFailures(const std::vector<Group>& groups, ResultTable& table) {
  for (const Group& group : groups) {
    for (const JobResult* result : group.runs) {
      if (!result->figures) AddFailure(group, result->reason, table.failures);
      for (const std::string& reason : result->earlier) {
        AddFailure(group, reason, table.tried_again);
      }
    }
  }
}

// Escapes characters that would end a cell.
std::string Escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? "\\|" : std::string(1, c);
  return escaped;
}

}  // namespace

Centre CentreOf(const Experiment& experiment) {
  return experiment.tolerated_failures ? Centre::kMean : Centre::kMedian;
}

std::optional<Spread> SpreadOf(std::vector<double> values, Centre centre) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  if (centre == Centre::kMean) {
    const double sum = std::accumulate(values.begin(), values.end(), 0.0);
    return Spread{sum / static_cast<double>(values.size()), values.front(), values.back()};
  }
  const std::size_t half = values.size() / 2;
  const double median =
      values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
  return Spread{median, values.front(), values.back()};
}

ResultTable MakeTable(const Plan& plan, const std::vector<JobResult>& results, MetricKind kind) {
  ResultTable table;
  table.kind = kind;
  table.columns = MetricsOf(plan.experiment, kind);
  const std::vector<Group> groups = GroupsOf(plan, results);
  for (const Group& group : groups) {
    table.rows.push_back(MakeRow(group, table, plan.experiment));
  }
  for (std::size_t begin = 0, end = 0; begin < table.rows.size(); begin = end) {
    while (end < table.rows.size() && table.rows[end].sequence == table.rows[begin].sequence) ++end;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      MarkBest(table, c, {begin, end});
    }
  }
  AddFailures(groups, table);
  return table;
}

std::string CellText(const TableRow& row, const TableCell& cell, const Metric& metric) {
  if (!cell.spread) return "-";
  std::string text = Number(cell.spread->centre, metric);
  const std::string min = Number(cell.spread->min, metric), max = Number(cell.spread->max, metric);
  if (min != max) text += fmt::format(" ({}-{})", min, max);
  if (cell.missing > row.failed) text += fmt::format(", {} without", cell.missing - row.failed);
  return text;
}

std::string RunsText(const TableRow& row) {
  std::vector<std::string> parts;
  const int distinct = row.runs - row.failed - row.same;
  if (distinct > 0) parts.push_back(std::to_string(distinct));
  if (row.same > 0) parts.push_back(fmt::format("{} the same", row.same));
  if (row.failed > 0) parts.push_back(fmt::format("{} failed", row.failed));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string ColumnTitle(const Metric& metric) {
  return metric.unit.empty() ? std::string(metric.name)
                             : fmt::format("{} [{}]", metric.name, metric.unit);
}

std::vector<std::string> FailureTexts(const Plan& plan, const ResultTable& table) {
  std::vector<std::string> texts;
  const auto add = [&](const char* what, const char* unit, const Failure& failure) {
    texts.push_back(fmt::format("{}: {}, {}, {}: {}",
                                what,
                                plan.sequences[failure.sequence].name,
                                plan.experiment.variants[failure.variant].name,
                                Counted(failure.runs, unit),
                                failure.reason));
  };
  for (const Failure& failure : table.failures) add("failed", "run", failure);
  for (const Failure& failure : table.tried_again) add("tried again after", "failure", failure);
  return texts;
}

std::string FormatMarkdown(const Plan& plan, const ResultTable& table) {
  const bool timing = table.kind == MetricKind::kTiming;
  std::string text = fmt::format("# {}{}\n\n{}. {} (range) over the runs{}.\n\n",
                                 plan.experiment.name,
                                 timing ? ": speed" : "",
                                 plan.experiment.help,
                                 CentreOf(plan.experiment) == Centre::kMean ? "Mean" : "Median",
                                 timing ? "" : "; runs with the same trajectory count once");
  text += "| sequence | variant | runs |";
  for (const Metric* metric : table.columns) text += " " + ColumnTitle(*metric) + " |";
  text += "\n|---|---|---|";
  for (std::size_t c = 0; c < table.columns.size(); ++c) text += "---|";
  text += "\n";
  for (const TableRow& row : table.rows) {
    text += fmt::format("| {} | {} | {} |",
                        Escaped(plan.sequences[row.sequence].name),
                        plan.experiment.variants[row.variant].name,
                        RunsText(row));
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      const std::string cell = CellText(row, row.cells[c], *table.columns[c]);
      text += row.cells[c].best ? " **" + cell + "** |" : " " + cell + " |";
    }
    text += "\n";
  }
  text += "\n";
  for (const std::string& pattern : plan.missing) {
    text += fmt::format("- not there: no sequence {}\n", pattern);
  }
  for (const std::string& failure : FailureTexts(plan, table)) text += "- " + failure + "\n";
  for (const Metric* metric : table.columns) {
    text += fmt::format("- {}: {}\n", metric->name, metric->help);
  }
  return text;
}

}  // namespace plumbline
