// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_maps/line_map_report.h"

#include "plumbline/base/options.h"

#include <cstddef>
#include <iomanip>
#include <numbers>
#include <optional>
#include <sstream>
#include <type_traits>
#include <vector>

#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

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

nlohmann::ordered_json OrNull(const std::optional<double>& value) {
  if (!value) return nullptr;
  return *value;
}

}  // namespace

std::string LineMapTable(const LineMapError& error, const LineMapErrorOptions& options) {
  constexpr double kCentimetres = 100, kPercent = 100;
  std::ostringstream table;
  table << std::fixed << std::setprecision(1);
  table << "lines       " << error.estimated_segments << " segments, " << error.estimated_length
        << " m, aligned by poses\ntrue lines  " << error.true_lines << ", " << error.true_length
        << " m; asked for " << error.asked_lines << ", " << error.asked_length << " m ("
        << AskedFor(options) << ")\n\n";
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

std::string LineMapJson(const LineMapError& error, const LineMapErrorOptions& options) {
  nlohmann::ordered_json json = {{"alignment", "poses"},
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
  return json.dump(2) + "\n";
}

}  // namespace plumbline
