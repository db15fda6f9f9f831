// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/figure_list.h"

#include <nlohmann/json.hpp>

namespace plumbline {

std::string FormatFigureList(const std::string& experiment, std::span<const FigureRow> rows) {
  std::string text = "[";
  for (const FigureRow& row : rows) {
    nlohmann::ordered_json json = {{"experiment", experiment},
                                   {"sequence", row.sequence},
                                   {"variant", row.variant},
                                   {"seed", nullptr},
                                   {"metric", row.metric},
                                   {"value", nullptr},
                                   {"unit", row.unit}};
    for (const char* key : {"sequence", "variant", "metric"}) {
      if (json[key] == "") json[key] = nullptr;
    }
    if (row.seed) json["seed"] = *row.seed;
    if (row.value) {
      json["value"] = *row.value;
    } else {
      json["reason"] = row.reason;
    }
    text += text.size() == 1 ? "\n" : ",\n";
    text += json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  }
  return text + "\n]\n";
}

}  // namespace plumbline
