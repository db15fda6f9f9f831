// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/evaluate_report.h"

#include "plumbline/base/options.h"

#include <algorithm>
#include <iomanip>
#include <numbers>
#include <sstream>

#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

std::string WindowName(const RelativeWindow& window) {
  if (window.frames > 0) return std::to_string(window.frames) + "f";
  std::ostringstream text;
  text << static_cast<double>(window.duration_ns) * 1e-9 << "s";
  return text.str();
}

nlohmann::ordered_json ToJson(const std::optional<ErrorStatistics>& statistics, double factor) {
  if (!statistics) return nullptr;
  return {{"count", statistics->count},
          {"rmse", factor * statistics->rmse},
          {"mean", factor * statistics->mean},
          {"median", factor * statistics->median},
          {"max", factor * statistics->max}};
}

void AddRow(std::ostringstream& table,
            const std::string& name,
            const std::optional<ErrorStatistics>& statistics,
            double factor) {
  table << std::left << std::setw(14) << name << std::right << std::setprecision(6);
  if (!statistics) {
    table << "  no pair of poses spans the window\n";
    return;
  }
  for (const double value :
       {statistics->rmse, statistics->mean, statistics->median, statistics->max}) {
    table << ' ' << std::setw(9) << factor * value;
  }
  table << ' ' << std::setw(8) << statistics->count << '\n';
}

// A row of the table of lines: one figure for each tolerance.
template <class Figure>
void AddLineRow(std::ostringstream& table,
                const std::string& name,
                int decimals,
                const std::vector<LineMapErrorAt>& rows,
                const Figure& figure) {
  table << std::left << std::setw(20) << name << std::right << std::setprecision(decimals);
  for (const LineMapErrorAt& at : rows) {
    const std::optional<double> value = figure(at);
    if (value) {
      table << ' ' << std::setw(9) << *value;
    } else {
      table << std::setw(10) << "-";
    }
  }
  table << '\n';
}

std::optional<double> Times(double factor, const std::optional<double>& value) {
  return value ? std::optional(factor * *value) : std::nullopt;
}

void AddLineRows(std::ostringstream& table, const std::vector<LineMapErrorAt>& rows) {
  constexpr double kPercent = 100, kMillimetres = 1000;
  AddLineRow(table, "recall [%]", 1, rows, [](const LineMapErrorAt& at) {
    return Times(kPercent, at.recall);
  });
  for (const auto& [kind, name] : EnumNames(std::type_identity<TrueLineKind>{})) {
    const auto index = static_cast<std::size_t>(kind);
    if (!rows.front().recall_by_kind[index]) continue;
    AddLineRow(table, std::string("  ") + name, 1, rows, [index](const LineMapErrorAt& at) {
      return Times(kPercent, at.recall_by_kind[index]);
    });
  }
  AddLineRow(table, "precision [%]", 1, rows, [](const LineMapErrorAt& at) {
    return Times(kPercent, at.precision);
  });
  AddLineRow(table, "with counterpart", 0, rows, [](const LineMapErrorAt& at) {
    return std::optional(static_cast<double>(at.with_counterpart));
  });
  AddLineRow(table, "  angle [deg]", 2, rows, [](const LineMapErrorAt& at) {
    return Times(kDegrees, at.median_angle);
  });
  AddLineRow(table, "  distance [mm]", 1, rows, [](const LineMapErrorAt& at) {
    return Times(kMillimetres, at.median_distance);
  });
  AddLineRow(table, "  segments per line", 2, rows, [](const LineMapErrorAt& at) {
    return at.segments_per_line;
  });
  AddLineRow(
      table, "  multiplicity", 2, rows, [](const LineMapErrorAt& at) { return at.multiplicity; });
}

// What makes a true line one that is asked for.
std::string AskedFor(const LineMapErrorOptions& options) {
  std::ostringstream text;
  if (options.viewers) {
    text << "seen from within " << options.viewers->max_distance << " m in "
         << options.viewers->min_frames << " or more of " << options.viewers->frames.size()
         << " keyframes";
  } else {
    text << "seen in " << options.min_visible_frames << " frames or more, where recorded";
  }
  return text.str();
}

std::string LineMapTable(const Evaluation& evaluation) {
  const LineMapError& error = *evaluation.lines;
  const LineMapErrorOptions& options = evaluation.line_options;
  constexpr double kCentimetres = 100, kPercent = 100;
  std::ostringstream table;
  table << std::fixed << std::setprecision(1);
  table << "\nlines       " << error.estimated_segments << " segments, " << error.estimated_length
        << " m, aligned by " << NameOf(evaluation.line_alignment) << "\ntrue lines  "
        << error.true_lines << ", " << error.true_length << " m; asked for " << error.asked_lines
        << ", " << error.asked_length << " m (" << AskedFor(options) << ")\n\n";
  table << std::left << std::setw(20) << "within [cm]" << std::right << std::setprecision(0);
  for (const LineMapErrorAt& at : error.at) table << std::setw(10) << kCentimetres * at.tolerance;
  table << '\n';
  AddLineRows(table, error.at);
  table << "uncovered at " << std::setprecision(0) << kCentimetres * error.at.back().tolerance
        << " cm  " << std::setprecision(1) << error.uncovered_length << " m";
  if (const auto& surfaces = error.uncovered_from_surfaces) {
    table << "; from the nearest surface " << kCentimetres * surfaces->median << " cm (median), "
          << kPercent * surfaces->share_beyond << " % further than "
          << kCentimetres * options.surface_limit << " cm";
  }
  table << '\n';
  return table.str();
}

nlohmann::ordered_json OrNull(const std::optional<double>& value) {
  if (!value) return nullptr;
  return *value;
}

nlohmann::ordered_json LineMapJson(const Evaluation& evaluation) {
  const LineMapError& error = *evaluation.lines;
  const LineMapErrorOptions& options = evaluation.line_options;
  nlohmann::ordered_json json = {{"alignment", NameOf(evaluation.line_alignment)},
                                 {"max_angle_deg", kDegrees * options.max_angle},
                                 {"asked_for", AskedFor(options)},
                                 {"segments", error.estimated_segments},
                                 {"segments_length_m", error.estimated_length},
                                 {"true_lines", error.true_lines},
                                 {"true_length_m", error.true_length},
                                 {"asked_lines", error.asked_lines},
                                 {"asked_length_m", error.asked_length}};
  json["tolerances"] = nlohmann::ordered_json::array();
  for (const LineMapErrorAt& at : error.at) {
    nlohmann::ordered_json kinds;
    for (const auto& [kind, name] : EnumNames(std::type_identity<TrueLineKind>{})) {
      kinds[name] = OrNull(at.recall_by_kind[static_cast<std::size_t>(kind)]);
    }
    json["tolerances"].push_back({{"tolerance_m", at.tolerance},
                                  {"recall", OrNull(at.recall)},
                                  {"recall_by_kind", kinds},
                                  {"precision", OrNull(at.precision)},
                                  {"with_counterpart", at.with_counterpart},
                                  {"median_angle_deg", OrNull(Times(kDegrees, at.median_angle))},
                                  {"median_distance_m", OrNull(at.median_distance)},
                                  {"segments_per_line", OrNull(at.segments_per_line)},
                                  {"multiplicity", OrNull(at.multiplicity)}});
  }
  json["uncovered"] = {{"length_m", error.uncovered_length},
                       {"surface_limit_m", options.surface_limit},
                       {"median_surface_distance_m", nullptr},
                       {"share_beyond_limit", nullptr}};
  if (const auto& surfaces = error.uncovered_from_surfaces) {
    json["uncovered"]["median_surface_distance_m"] = surfaces->median;
    json["uncovered"]["share_beyond_limit"] = surfaces->share_beyond;
  }
  return json;
}

}  // namespace

std::string EvaluationTable(const Evaluation& evaluation) {
  const TrajectoryError& error = evaluation.error;
  std::ostringstream table;
  table << std::fixed << std::setprecision(1);
  table << "frames      " << error.estimated << " with a pose of ";
  if (evaluation.frames_delivered) {
    table << *evaluation.frames_delivered << " delivered ("
          << 100.0 * static_cast<double>(error.estimated) /
                 static_cast<double>(std::max<std::size_t>(1, *evaluation.frames_delivered))
          << " %)";
  } else {
    table << "an unknown number";
  }
  table << ", " << error.poses.size() << " compared\n" << std::setprecision(6);
  table << "alignment   " << NameOf(evaluation.options.alignment);
  if (evaluation.options.alignment == TrajectoryAlignment::kSim3) {
    table << ", scale " << error.reference_from_estimate.scale;
    if (error.scale_drift) {
      table << std::setprecision(2) << ", drift of the scale " << 100 * *error.scale_drift << " %";
    }
  }
  if (error.degenerate) {
    table << " (not determined by the positions: " << NameOf(*error.degenerate)
          << "; orientations decide the rest)";
  }
  table << "\nwindow      " << WindowName(evaluation.options.window) << "\n\n";
  table << std::setw(24) << "RMSE" << std::setw(10) << "mean" << std::setw(10) << "median"
        << std::setw(10) << "max" << std::setw(9) << "count" << '\n';
  AddRow(table, "ATE [m]", error.ate, 1);
  AddRow(table, "RPE [m/s]", error.rpe, 1);
  AddRow(table, "ROE [deg/s]", error.roe, kDegrees);
  if (evaluation.lines) table << LineMapTable(evaluation);
  return table.str();
}

std::string EvaluationJson(const Evaluation& evaluation) {
  const TrajectoryError& error = evaluation.error;
  nlohmann::ordered_json json;
  json["alignment"] = NameOf(evaluation.options.alignment);
  json["association"] = NameOf(evaluation.options.association);
  json["window"] = WindowName(evaluation.options.window);
  json["frames_delivered"] = nullptr;
  json["frames_with_pose"] = error.estimated;
  json["frames_compared"] = error.poses.size();
  json["coverage"] = nullptr;
  if (evaluation.frames_delivered && *evaluation.frames_delivered > 0) {
    json["frames_delivered"] = *evaluation.frames_delivered;
    json["coverage"] =
        static_cast<double>(error.estimated) / static_cast<double>(*evaluation.frames_delivered);
  }
  json["scale"] = error.reference_from_estimate.scale;
  json["scale_drift"] = nullptr;
  if (error.scale_drift) json["scale_drift"] = *error.scale_drift;
  json["degenerate"] = nullptr;
  if (error.degenerate) json["degenerate"] = NameOf(*error.degenerate);
  json["ate_m"] = ToJson(error.ate, 1);
  json["rpe_m_per_s"] = ToJson(error.rpe, 1);
  json["roe_deg_per_s"] = ToJson(error.roe, kDegrees);
  json["line_map"] = nullptr;
  if (evaluation.lines) json["line_map"] = LineMapJson(evaluation);
  constexpr int kIndent = 2;
  return json.dump(kIndent) + "\n";
}

}  // namespace plumbline
