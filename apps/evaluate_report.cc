// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/evaluate_report.h"

#include "plumbline/base/options.h"
#include "plumbline/base/printable.h"
#include "plumbline/io/trajectory_io.h"

#include <algorithm>
#include <iomanip>
#include <numbers>
#include <sstream>
#include <utility>

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
          {"max", factor * statistics->max},
          {"std", factor * statistics->deviation},
          {"p75", factor * statistics->p75},
          {"p95", factor * statistics->p95}};
}

constexpr int kErrorName = 14;  // width of the first column

// The heads of the columns of AddRow.
void AddHead(std::ostringstream& table, const std::string& name, int width) {
  table << std::left << std::setw(width) << name << std::right;
  for (const char* head : {"RMSE", "mean", "median", "std", "p75", "p95", "max"}) {
    table << std::setw(10) << head;
  }
  table << std::setw(9) << "count" << '\n';
}

void AddRow(std::ostringstream& table,
            const std::string& name,
            int width,
            const std::optional<ErrorStatistics>& statistics,
            double factor,
            const RelativeWindow& window) {
  table << std::left << std::setw(width) << name << std::right << std::setprecision(6);
  if (!statistics) {
    table << "  no pair of poses spans the window"
          << (window.frames == 0 ? "; --delta 1f compares neighbouring poses\n" : "\n");
    return;
  }
  for (const double value : {statistics->rmse,
                             statistics->mean,
                             statistics->median,
                             statistics->deviation,
                             statistics->p75,
                             statistics->p95,
                             statistics->max}) {
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

// Criteria of the true lines that should be found.
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

// AddAlignment says in words how an estimate was aligned.
void AddAlignment(std::ostringstream& table, const Evaluation& evaluation) {
  const TrajectoryError& error = evaluation.error;
  table << std::setprecision(6) << NameOf(evaluation.options.alignment);
  if (evaluation.aligned_by) table << " by " << Printable(*evaluation.aligned_by);
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
  if (evaluation.unit_is_free) {
    table << " (of one camera: lengths of the estimate are in units of its own, not metres)";
  }
}

void AddFrames(std::ostringstream& table, const Evaluation& evaluation) {
  const TrajectoryError& error = evaluation.error;
  table << error.estimated << " with a pose of ";
  if (evaluation.frames_delivered) {
    table << *evaluation.frames_delivered << " delivered (" << std::setprecision(1)
          << 100.0 * static_cast<double>(error.estimated) /
                 static_cast<double>(std::max<std::size_t>(1, *evaluation.frames_delivered))
          << " %)";
  } else {
    table << "an unknown number";
  }
  table << ", " << error.poses.size() << " compared";
}

void AddOffset(std::ostringstream& table, const Evaluation& evaluation) {
  if (evaluation.offset_ns == 0) return;
  table << "time offset " << FormatStamp(evaluation.offset_ns)
        << " s, added to the stamps of the estimate\n";
}

nlohmann::ordered_json ToJson(const Evaluation& evaluation) {
  const TrajectoryError& error = evaluation.error;
  nlohmann::ordered_json json;
  json["alignment"] = NameOf(evaluation.options.alignment);
  json["aligned_by"] = nullptr;
  if (evaluation.aligned_by) json["aligned_by"] = *evaluation.aligned_by;
  json["association"] = NameOf(evaluation.options.association);
  json["time_offset_s"] = 1e-9 * static_cast<double>(evaluation.offset_ns);
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
  json["scale_drift"] = OrNull(error.scale_drift);
  json["degenerate"] = nullptr;
  if (error.degenerate) json["degenerate"] = NameOf(*error.degenerate);
  json["ate_m"] = ToJson(error.ate, 1);
  json["rpe_m_per_s"] = ToJson(error.rpe, 1);
  json["roe_deg_per_s"] = ToJson(error.roe, kDegrees);
  json["line_map"] = nullptr;
  if (evaluation.lines) json["line_map"] = LineMapJson(evaluation);
  return json;
}

// The text of a value. Bytes of a path that are no UTF-8 become the sign for that.
std::string TextOf(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string EvaluationTable(const Evaluation& evaluation) {
  const TrajectoryError& error = evaluation.error;
  std::ostringstream table;
  table << std::fixed << "frames      ";
  AddFrames(table, evaluation);
  table << "\nalignment   ";
  AddAlignment(table, evaluation);
  table << '\n';
  AddOffset(table, evaluation);
  table << "window      " << WindowName(evaluation.options.window) << "\n\n";
  AddHead(table, "", kErrorName);
  const RelativeWindow& window = evaluation.options.window;
  AddRow(table, "ATE [m]", kErrorName, error.ate, 1, window);
  AddRow(table, "RPE [m/s]", kErrorName, error.rpe, 1, window);
  AddRow(table, "ROE [deg/s]", kErrorName, error.roe, kDegrees, window);
  if (evaluation.lines) table << LineMapTable(evaluation);
  return table.str();
}

std::string EvaluationJson(const Evaluation& evaluation) { return TextOf(ToJson(evaluation)); }

std::string EvaluationsTable(const std::vector<Evaluation>& evaluations) {
  std::size_t longest = kErrorName - 2;
  for (const Evaluation& each : evaluations) longest = std::max(longest, each.name.size());
  const int width = static_cast<int>(longest) + 2;
  std::ostringstream table;
  table << std::fixed;
  const auto name = [&](const Evaluation& each) {
    table << std::left << std::setw(width) << each.name << std::right;
  };
  table << "frames\n";
  for (const Evaluation& each : evaluations) {
    name(each);
    AddFrames(table, each);
    table << '\n';
  }
  table << "\nalignment\n";
  for (const Evaluation& each : evaluations) {
    name(each);
    AddAlignment(table, each);
    table << '\n';
  }
  table << '\n';
  AddOffset(table, evaluations.front());
  table << "window      " << WindowName(evaluations.front().options.window) << '\n';
  const auto add = [&](const char* error, auto member, double factor) {
    table << '\n';
    AddHead(table, error, width);
    for (const Evaluation& each : evaluations) {
      AddRow(table, each.name, width, each.error.*member, factor, each.options.window);
    }
  };
  add("ATE [m]", &TrajectoryError::ate, 1);
  add("RPE [m/s]", &TrajectoryError::rpe, 1);
  add("ROE [deg/s]", &TrajectoryError::roe, kDegrees);
  for (const Evaluation& each : evaluations) {
    if (each.lines) table << "\nlines of " << each.name << LineMapTable(each);
  }
  return table.str();
}

std::string EvaluationsJson(const std::vector<Evaluation>& evaluations) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Evaluation& each : evaluations) {
    nlohmann::ordered_json json = {{"estimate", each.estimate}, {"name", each.name}};
    json.update(ToJson(each));
    list.push_back(std::move(json));
  }
  nlohmann::ordered_json json;
  json["estimates"] = std::move(list);
  return TextOf(json);
}

}  // namespace plumbline
