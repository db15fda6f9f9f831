// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plumbline {

// A YAML file of this folder, embedded in the library.
struct EmbeddedYaml {
  const char* name;  // "printed/rippl.yaml"
  const char* text;
};
const std::vector<EmbeddedYaml>& PrintedFiles();
const EmbeddedYaml& GateLimitsFile();

// A cell of a printed table: a number, or a word instead ("ambiguity", "-").
struct PrintedCell {
  std::optional<double> value;
  std::string text;  // as printed
};

struct PrintedRow {
  std::string sequence;            // name in SequenceChoice::paper
  std::vector<PrintedCell> cells;  // one for each variant
};

// A table of a paper, or its part about one figure.
struct PrintedTable {
  std::string experiment;
  std::string paper;  // "Lee and Hwang, ICCV 2019"
  std::string where;  // "Table 1, page 7"
  std::string metric, unit;
  std::string note;  // known differences from ours; may be empty
  std::vector<std::string> variants;
  std::vector<PrintedRow> rows;
};

// A paper's statement about a figure in words, or about a plot without printed values.
struct PrintedStatement {
  std::string experiment, paper, where, text;
};

struct PrintedFigures {
  std::vector<PrintedTable> tables;
  std::vector<PrintedStatement> statements;
};

// Reads one file. Throws InputError "name: ..." for text that is not of this form: an unknown key,
// a row with more or fewer cells than variants.
PrintedFigures ParsePrintedFigures(const EmbeddedYaml& file);

// Returns the figures of an experiment in all files, in their order.
PrintedFigures PrintedFiguresOf(std::string_view experiment);

// Returns the factor from `unit` to `other`: 10 from cm to mm; nullopt if they measure different
// quantities.
std::optional<double> UnitFactor(std::string_view unit, std::string_view other);

}  // namespace plumbline
