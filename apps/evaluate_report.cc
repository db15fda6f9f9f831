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

nlohmann::ordered_json OrNull(const std::optional<double>& value) {
  if (!value) return nullptr;
  return *value;
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
