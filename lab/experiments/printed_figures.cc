// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/printed_figures.h"

#include "plumbline/base/error.h"
#include "plumbline/base/yaml_document.h"
#include "plumbline/io/text_rows.h"

#include <algorithm>
#include <array>
#include <initializer_list>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace plumbline {
namespace {

class Reader {
 public:
  explicit Reader(std::string file) : file_(std::move(file)) {}

  [[noreturn]] void Fail(const YAML::Node& node, const std::string& message) const {
    throw InputError(fmt::format("{}:{}: {}", file_, node.Mark().line + 1, message));
  }

  void OnlyKeys(const YAML::Node& node, std::initializer_list<std::string_view> known) const {
    if (!node.IsMap()) Fail(node, "expected a group of keys");
    for (const auto& entry : node) {
      const auto key = entry.first.as<std::string>();
      if (std::find(known.begin(), known.end(), key) == known.end()) {
        Fail(entry.first, "unknown key " + key);
      }
    }
  }

  std::string Text(const YAML::Node& node, const char* key) const {
    const YAML::Node value = node[key];
    if (!value || !value.IsScalar()) Fail(node, fmt::format("expected {}: and a text", key));
    return value.as<std::string>();
  }

  std::vector<std::string> Texts(const YAML::Node& node) const {
    if (!node || !node.IsSequence()) Fail(node, "expected a list");
    std::vector<std::string> texts;
    for (const YAML::Node& entry : node) {
      if (!entry.IsScalar()) Fail(entry, "expected a number or a word");
      texts.push_back(entry.as<std::string>());
    }
    return texts;
  }

 private:
  std::string file_;
};

PrintedRow ReadRow(const Reader& reader,
                   const YAML::Node& name,
                   const YAML::Node& cells,
                   std::size_t count) {
  PrintedRow row;
  row.sequence = name.as<std::string>();
  for (const std::string& text : reader.Texts(cells)) {
    row.cells.push_back({ParseNumber(text), text});
  }
  if (row.cells.size() != count) {
    reader.Fail(cells,
                fmt::format("expected {} cells, one a variant, found {}", count, row.cells.size()));
  }
  return row;
}

PrintedTable ReadTable(const Reader& reader, const std::string& paper, const YAML::Node& node) {
  reader.OnlyKeys(node, {"experiment", "where", "metric", "unit", "note", "variants", "rows"});
  PrintedTable table;
  table.experiment = reader.Text(node, "experiment");
  table.paper = paper;
  table.where = reader.Text(node, "where");
  table.metric = reader.Text(node, "metric");
  table.unit = reader.Text(node, "unit");
  if (node["note"]) table.note = reader.Text(node, "note");
  table.variants = reader.Texts(node["variants"]);
  if (!node["rows"].IsMap()) reader.Fail(node, "expected rows: and a group of rows");
  for (const auto& row : node["rows"]) {
    table.rows.push_back(ReadRow(reader, row.first, row.second, table.variants.size()));
  }
  return table;
}

PrintedFigures ReadAll(const Reader& reader, const YAML::Node& root) {
  PrintedFigures figures;
  reader.OnlyKeys(root, {"paper", "tables", "statements"});
  const std::string paper = reader.Text(root, "paper");
  for (const YAML::Node& node : root["tables"]) {
    figures.tables.push_back(ReadTable(reader, paper, node));
  }
  for (const YAML::Node& node : root["statements"]) {
    reader.OnlyKeys(node, {"experiment", "where", "text"});
    figures.statements.push_back({reader.Text(node, "experiment"),
                                  paper,
                                  reader.Text(node, "where"),
                                  reader.Text(node, "text")});
  }
  return figures;
}

}  // namespace

PrintedFigures ParsePrintedFigures(const EmbeddedYaml& file) {
  return ReadAll(Reader(file.name), ParseYaml(file.text, file.name));
}

PrintedFigures PrintedFiguresOf(std::string_view experiment) {
  PrintedFigures of;
  for (const EmbeddedYaml& file : PrintedFiles()) {
    PrintedFigures all = ParsePrintedFigures(file);
    for (PrintedTable& table : all.tables) {
      if (table.experiment == experiment) of.tables.push_back(std::move(table));
    }
    for (PrintedStatement& statement : all.statements) {
      if (statement.experiment == experiment) of.statements.push_back(std::move(statement));
    }
  }
  return of;
}

std::optional<double> UnitFactor(std::string_view unit, std::string_view other) {
  struct Length {
    std::string_view name;
    double metres;
  };
  constexpr std::array kLengths = {Length{"m", 1}, Length{"cm", 0.01}, Length{"mm", 0.001}};
  if (unit == other) return 1;
  std::optional<double> from, to;
  for (const Length& length : kLengths) {
    if (length.name == unit) from = length.metres;
    if (length.name == other) to = length.metres;
  }
  if (!from || !to) return std::nullopt;
  return *from / *to;
}

}  // namespace plumbline
