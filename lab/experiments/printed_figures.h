// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plumbline {

// A YAML file of this folder that became part of the library.
struct EmbeddedYaml {
  const char* name;  // "printed/rippl.yaml"
  const char* text;
};
const std::vector<EmbeddedYaml>& PrintedFiles();
const EmbeddedYaml& GateLimitsFile();

// A cell of a printed table: a number, or the word that stands there instead ("ambiguity", "-").
struct PrintedCell {
  std::optional<double> value;
  std::string text;  // as printed
};

struct PrintedRow {
  std::string sequence;            // as SequenceChoice::paper names it
  std::vector<PrintedCell> cells;  // one for each variant
};

// A table of a paper, or the part of it that is about one figure.
struct PrintedTable {
  std::string experiment;
  std::string paper;  // "Lee and Hwang, ICCV 2019"
  std::string where;  // "Table 1, page 7"
  std::string metric, unit;
  std::string note;  // what keeps ours from being the same; may be empty
  std::vector<std::string> variants;
  std::vector<PrintedRow> rows;
};

// What a paper says of a figure in words, or of a plot whose values it does not print.
struct PrintedStatement {
  std::string experiment, paper, where, text;
};

struct PrintedFigures {
  std::vector<PrintedTable> tables;
  std::vector<PrintedStatement> statements;
};

// Reads one file. Throws InputError "name: ..." for text that is not of this form: an unknown key,
// a row whose cells are not as many as the variants.
PrintedFigures ParsePrintedFigures(const EmbeddedYaml& file);

// Those of all files that belong to an experiment, in their order.
PrintedFigures PrintedFiguresOf(std::string_view experiment);

// Times that number of `unit` makes one of `other`: 10 from cm to mm; nullopt where they do not
// measure the same.
std::optional<double> UnitFactor(std::string_view unit, std::string_view other);

}  // namespace plumbline
