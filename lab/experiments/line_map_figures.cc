// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/line_map_figures.h"

#include "lab/line_maps/line_map_error.h"
#include "lab/line_maps/run_line_map.h"
#include "plumbline/base/error.h"
#include "plumbline/report/trajectory_error.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr double kTolerance = 0.05;  // metres

// Compares lines of a run with those of its sequence, at kTolerance.
LineMapErrorAt CompareLinesOf(const RunLineMap& run) {
  LineMapErrorOptions options;
  options.tolerances = {kTolerance};
  options.viewers = run.viewers;
  return CompareLineMaps(run.truth, run.lines, run.surfaces, options).at[0];
}

// Returns true if true lines and a non-empty trajectory exist.
bool CanCompareLines(const fs::path& sequence, const RunFigures& figures) {
  std::error_code error;
  const auto coverage = figures.values.find("coverage");
  return fs::exists(sequence / "lines.csv", error) && coverage != figures.values.end() &&
         coverage->second > 0;
}

// Adds `value`, in the unit of the metric, or why there is none.
void AddLineFigure(const char* name,
                   double factor,
                   const std::optional<double>& value,
                   RunFigures& figures) {
  figures.reasons.erase(name);
  if (value) {
    figures.values[name] = factor * *value;
  } else {
    figures.reasons[name] = "no line has a counterpart";
  }
}

// Returns the distance of the further end of a line from the nearest true line, ends included: it
// measures offset to the side, rotation, and excess length. The median of all lines; nullopt
// without lines or true lines.
std::optional<double> MedianEndError(std::span<const TrueLine> truth,
                                     std::span<const Segment3> lines) {
  if (truth.empty()) return std::nullopt;
  std::vector<double> errors;
  for (const Segment3& line : lines) {
    double least = std::numeric_limits<double>::infinity();
    for (const TrueLine& candidate : truth) {
      const double start = Distance(candidate.segment, line.start);
      if (start >= least) continue;
      least = std::min(least, std::max(start, Distance(candidate.segment, line.end)));
    }
    errors.push_back(least);
  }
  const auto statistics = StatisticsOf(std::move(errors));
  return statistics ? std::optional(statistics->median) : std::nullopt;
}

constexpr double kPercent = 100, kMillimetres = 1000, kDegrees = 180 / std::numbers::pi;
constexpr std::array kLineMapMetrics = {
    "line_recall", "line_precision", "line_angle", "line_distance", "line_multiplicity"};
constexpr std::array kMapLineMetrics = {
    "map_line_recall", "map_line_precision", "map_line_angle", "map_line_error"};

template <class Names>
void SayUnreadable(const Names& names, RunFigures& figures) {
  for (const char* name : names) figures.reasons[name] = "the lines cannot be read";
}

}  // namespace

void AddLineMapFigures(const fs::path& sequence, const fs::path& run, RunFigures& figures) {
  if (!CanCompareLines(sequence, figures)) return;
  try {
    const auto map = ReadRunLineMap(sequence, run, run / "lines.obj");
    if (!map) return;
    const LineMapErrorAt at = CompareLinesOf(*map);
    AddLineFigure("line_recall", kPercent, at.recall, figures);
    AddLineFigure("line_precision", kPercent, at.precision, figures);
    AddLineFigure("line_angle", kDegrees, at.median_angle, figures);
    AddLineFigure("line_distance", kMillimetres, at.median_distance, figures);
    AddLineFigure("line_multiplicity", 1, at.multiplicity, figures);
  } catch (const InputError&) {
    SayUnreadable(kLineMapMetrics, figures);
  }
}

bool AsksForMapLines(std::span<const std::string> metrics) {
  return std::any_of(metrics.begin(), metrics.end(), [](const std::string& name) {
    return std::find(kMapLineMetrics.begin(), kMapLineMetrics.end(), name) != kMapLineMetrics.end();
  });
}

void AddMapLineFigures(const fs::path& sequence, const fs::path& run, RunFigures& figures) {
  if (!CanCompareLines(sequence, figures)) return;
  try {
    const auto map = ReadRunLineMap(sequence, run, run / "map.plb");
    if (!map) return;
    const LineMapErrorAt at = CompareLinesOf(*map);
    AddLineFigure("map_line_recall", kPercent, at.recall, figures);
    AddLineFigure("map_line_precision", kPercent, at.precision, figures);
    AddLineFigure("map_line_angle", kDegrees, at.median_angle, figures);
    AddLineFigure("map_line_error", kMillimetres, MedianEndError(map->truth, map->lines), figures);
  } catch (const InputError&) {
    SayUnreadable(kMapLineMetrics, figures);
  }
}

}  // namespace plumbline
