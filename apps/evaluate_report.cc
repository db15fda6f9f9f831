// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/evaluate_report.h"

#include "plumbline/base/error.h"

#include <algorithm>
#include <iomanip>
#include <numbers>
#include <sstream>

#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

template <class Enum>
std::string NameOf(Enum value) {
  for (const auto& [candidate, name] : EnumNames(std::type_identity<Enum>{})) {
    if (candidate == value) return name;
  }
  throw BugError("an enumerator without a name");
}

std::string WindowName(const RelativeWindow& window) {
  if (window.frames > 0) return std::to_string(window.frames) + "f";
  std::ostringstream text;
  text << static_cast<double>(window.duration_ns) * 1e-9 << "s";
  return text.str();
}

std::string DegeneracyName(AlignmentFailure failure) {
  switch (failure) {
    case AlignmentFailure::kTooFewPoints:
      return "fewer than three poses";
    case AlignmentFailure::kCoincident:
      return "all positions in one place";
    case AlignmentFailure::kCollinear:
      return "all positions on a line";
  }
  throw BugError("a failure without a name");
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
  table << std::left << std::setw(14) << name << std::right;
  if (!statistics) {
    table << "  no pair of poses spans the window\n";
    return;
  }
  for (const double value :
       {statistics->rmse, statistics->mean, statistics->median, statistics->max}) {
    table << std::setw(10) << factor * value;
  }
  table << std::setw(9) << statistics->count << '\n';
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
  }
  if (error.degenerate) {
    table << " (not determined by the positions: " << DegeneracyName(*error.degenerate)
          << "; the first pose is used)";
  }
  table << "\nwindow      " << WindowName(evaluation.options.window) << "\n\n";
  table << std::setw(24) << "RMSE" << std::setw(10) << "mean" << std::setw(10) << "median"
        << std::setw(10) << "max" << std::setw(9) << "count" << '\n';
  AddRow(table, "ATE [m]", error.ate, 1);
  AddRow(table, "RPE [m/s]", error.rpe, 1);
  AddRow(table, "ROE [deg/s]", error.roe, kDegrees);
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
  json["degenerate"] = nullptr;
  if (error.degenerate) json["degenerate"] = DegeneracyName(*error.degenerate);
  json["ate_m"] = ToJson(error.ate, 1);
  json["rpe_m_per_s"] = ToJson(error.rpe, 1);
  json["roe_deg_per_s"] = ToJson(error.roe, kDegrees);
  constexpr int kIndent = 2;
  return json.dump(kIndent) + "\n";
}

}  // namespace plumbline
