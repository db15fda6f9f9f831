// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/starts/start_figures.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace plumbline {
namespace {

using Figures = std::map<std::string, double, std::less<>>;
constexpr double kPercent = 100;

void AddCounts(std::span<const StartRecord> records, Figures& figures) {
  double possible = 0, known = 0, success = 0, late = 0, waiting = 0, wrong = 0, accepted = 0;
  for (const StartRecord& record : records) {
    const auto is_possible = IsPossible(record);
    known += is_possible.has_value();
    wrong += record.outcome == StartOutcome::kWrong;
    accepted += record.map.has_value();
    if (!is_possible.value_or(false)) continue;
    ++possible;
    success += record.outcome == StartOutcome::kRight;
    late += record.outcome == StartOutcome::kLate;
    waiting += record.outcome == StartOutcome::kWaiting;
  }
  const auto all = static_cast<double>(records.size());
  figures["starts"] = all;
  figures["wrong"] = wrong;
  if (all > 0) {
    figures["wrong_rate"] = kPercent * wrong / all;
    figures["accepted"] = kPercent * accepted / all;
  }
  if (known > 0) {
    figures["possible"] = possible;
    figures["late"] = late;
    figures["waiting"] = waiting;
  }
  if (possible > 0) {
    figures["success"] = kPercent * success / possible;
    figures["success_in_the_end"] = kPercent * (success + late) / possible;
  }
}

}  // namespace

std::optional<bool> IsPossible(const StartRecord& record) {
  if (!record.greatest_parallax_deg) return std::nullopt;
  return *record.greatest_parallax_deg >= kPossibleParallaxDeg;
}

double Percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(share * static_cast<double>(values.size()) - 1e-9);
  const auto index = static_cast<std::size_t>(std::max(rank, 1.0)) - 1;
  return values[std::min(index, values.size() - 1)];
}

Figures FiguresOf(std::span<const StartRecord> records) {
  Figures figures;
  AddCounts(records, figures);
  // Figures of the maps; unknown values are left out.
  const auto add = [&](const std::string& name, bool with_p95, double factor, const auto& value) {
    std::vector<double> values;
    for (const StartRecord& record : records) {
      if (!record.map) continue;
      if (const std::optional<double> known = value(*record.map)) values.push_back(factor * *known);
    }
    if (values.empty()) return;
    figures[name] = Percentile(values, 0.5);
    if (with_p95) figures[name + "_p95"] = Percentile(values, 0.95);
  };
  using Known = std::optional<double>;
  add("map_frames", true, 1, [](const StartMap& m) { return Known(m.frames); });
  add("map_seconds", true, 1, [](const StartMap& m) { return Known(m.seconds); });
  add("map_parallax", false, 1, [](const StartMap& m) { return m.parallax_deg; });
  add("rotation_error", true, 1, [](const StartMap& m) { return m.errors.rotation_deg; });
  add("direction_error", true, 1, [](const StartMap& m) { return m.errors.direction_deg; });
  add("depth_error", true, kPercent, [](const StartMap& m) { return m.errors.depth; });
  add("depth_outliers", false, kPercent, [](const StartMap& m) { return m.errors.depth_outliers; });
  add("map_points", false, 1, [](const StartMap& m) { return Known(m.points); });
  add("map_lines", false, 1, [](const StartMap& m) { return Known(m.lines); });
  return figures;
}

}  // namespace plumbline
