// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/paper_comparison.h"

#include "plumbline/base/printable.h"

#include <algorithm>
#include <functional>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumbline {
namespace {

constexpr const char* kNotThere = "-";

// Index of the figures of one metric in a table of results.
class OurFigures {
 public:
  OurFigures(const Plan& plan, const ResultTable& table, std::size_t column)
      : plan_(plan), table_(table), column_(column) {}

  // Empty if the variant does not exist, "-" if it has no figure.
  std::string Cell(std::size_t sequence, const std::string& variant) const {
    const TableRow* row = Find(sequence, variant);
    return row == nullptr ? "" : CellText(*row, row->cells[column_], *table_.columns[column_]);
  }

  // Counted runs: once if all of these variants have the same, otherwise for each.
  std::string Runs(std::size_t sequence, const std::vector<std::string>& variants) const {
    std::vector<std::string> runs;
    for (const std::string& variant : variants) {
      const TableRow* row = Find(sequence, variant);
      if (row != nullptr) runs.push_back(RunsText(*row));
    }
    const bool alike =
        std::adjacent_find(runs.begin(), runs.end(), std::not_equal_to<>()) == runs.end();
    return alike && !runs.empty() ? runs.front() : fmt::format("{}", fmt::join(runs, "; "));
  }

 private:
  const TableRow* Find(std::size_t sequence, const std::string& variant) const {
    const auto row = std::find_if(table_.rows.begin(), table_.rows.end(), [&](const TableRow& r) {
      return r.sequence == sequence && plan_.experiment.variants[r.variant].name == variant;
    });
    return row == table_.rows.end() ? nullptr : &*row;
  }

  const Plan& plan_;
  const ResultTable& table_;
  std::size_t column_;
};

std::string PrintedText(const PrintedCell& cell, double factor) {
  return cell.value ? fmt::format("{:.6g}", *cell.value * factor) : cell.text;
}

std::string LabelOf(const ExperimentSequence& sequence) {
  if (sequence.paper.empty()) return sequence.name;
  if (!sequence.part) return sequence.paper;
  return fmt::format("{} (a part: {})", sequence.paper, sequence.name);
}

ComparedTable::Row RowOf(const std::string& label,
                         const PrintedRow* printed,
                         double factor,
                         std::size_t count) {
  ComparedTable::Row row;
  row.sequence = label;
  for (std::size_t v = 0; v < count; ++v) {
    row.printed.push_back(printed != nullptr ? PrintedText(printed->cells[v], factor) : "");
  }
  return row;
}

// Of a sequence that is not there.
std::string HowToRun(const Experiment& experiment, const std::string& paper) {
  for (const SequenceChoice& choice : experiment.sequences) {
    if (choice.paper != paper) continue;
    return fmt::format(
        "not there: `experiment {} --full --only {}`", experiment.name, choice.pattern);
  }
  return "not there";
}

void AddRows(const Plan& plan,
             const PrintedTable& printed,
             const OurFigures& ours,
             double factor,
             ComparedTable& out) {
  const std::size_t count = printed.variants.size();
  const auto add = [&](std::size_t sequence, const PrintedRow* row) {
    out.rows.push_back(RowOf(LabelOf(plan.sequences[sequence]), row, factor, count));
    for (const std::string& variant : printed.variants) {
      out.rows.back().ours.push_back(ours.Cell(sequence, variant));
    }
    out.rows.back().runs = ours.Runs(sequence, printed.variants);
  };
  std::vector<bool> shown(plan.sequences.size(), false);
  for (const PrintedRow& row : printed.rows) {
    bool found = false;
    for (std::size_t s = 0; s < plan.sequences.size(); ++s) {
      if (plan.sequences[s].paper != row.sequence) continue;
      add(s, &row);
      shown[s] = found = true;
    }
    if (found) continue;
    out.rows.push_back(RowOf(row.sequence, &row, factor, count));
    out.rows.back().ours.assign(count, kNotThere);
    out.rows.back().runs = HowToRun(plan.experiment, row.sequence);
  }
  for (std::size_t s = 0; s < plan.sequences.size(); ++s) {
    if (!shown[s]) add(s, nullptr);
  }
}

std::optional<ComparedTable> Compare(const Plan& plan,
                                     const ResultTable& table,
                                     const PrintedTable& printed) {
  const auto column = std::find_if(table.columns.begin(), table.columns.end(), [&](auto* metric) {
    return metric->name == printed.metric;
  });
  if (column == table.columns.end()) return std::nullopt;
  const auto factor = UnitFactor(printed.unit, (*column)->unit);
  ComparedTable out;
  out.title = fmt::format("{}: {}, {}", ColumnTitle(**column), printed.paper, printed.where);
  out.note = printed.note;
  out.metric = printed.metric;
  out.variants = printed.variants;
  const OurFigures ours(plan, table, static_cast<std::size_t>(column - table.columns.begin()));
  AddRows(plan, printed, ours, factor.value_or(1), out);
  return out;
}

// Returns false for a column of a paper about another system, without a counterpart of ours.
bool HasOurs(const ComparedTable& table, std::size_t variant) {
  return std::any_of(table.rows.begin(), table.rows.end(), [&](const auto& row) {
    return !row.ours[variant].empty() && row.ours[variant] != kNotThere;
  });
}

std::string MarkdownRow(const std::vector<std::string>& cells) {
  std::string text = "|";
  for (const std::string& cell : cells) text += " " + cell + " |";
  return text + "\n";
}

std::string HtmlRow(const std::vector<std::string>& cells, const char* kind) {
  std::string html = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const char* tag = i == 0 ? "th" : kind;
    html += fmt::format("<{0}>{1}</{0}>", tag, EscapeHtml(cells[i]));
  }
  return html + "</tr>\n";
}

}  // namespace

std::vector<std::string> ComparisonHeader(const ComparedTable& table) {
  std::vector<std::string> header = {"sequence"};
  for (std::size_t v = 0; v < table.variants.size(); ++v) {
    header.push_back(table.variants[v] + ", paper");
    if (HasOurs(table, v)) header.push_back(table.variants[v] + ", ours");
  }
  header.emplace_back("runs");
  return header;
}

std::vector<std::string> ComparisonCells(const ComparedTable& table,
                                         const ComparedTable::Row& row) {
  std::vector<std::string> cells = {row.sequence};
  for (std::size_t v = 0; v < table.variants.size(); ++v) {
    cells.push_back(row.printed[v]);
    if (HasOurs(table, v)) cells.push_back(row.ours[v]);
  }
  cells.push_back(row.runs);
  return cells;
}

PaperComparison CompareWithPaper(const Plan& plan, const ResultTable& table) {
  PrintedFigures printed = PrintedFiguresOf(plan.experiment.name);
  PaperComparison comparison;
  comparison.statements = std::move(printed.statements);
  for (const PrintedTable& of_paper : printed.tables) {
    if (auto compared = Compare(plan, table, of_paper)) {
      comparison.tables.push_back(*std::move(compared));
    }
  }
  return comparison;
}

std::string FormatComparisonMarkdown(const PaperComparison& comparison) {
  if (comparison.tables.empty() && comparison.statements.empty()) return "";
  std::string text = "\n## Beside the paper\n\n";
  for (const ComparedTable& table : comparison.tables) {
    text += fmt::format("### {}\n\n", table.title);
    if (!table.note.empty()) text += table.note + "\n\n";
    const std::vector<std::string> header = ComparisonHeader(table);
    text += MarkdownRow(header) + "|";
    for (std::size_t i = 0; i < header.size(); ++i) text += "---|";
    text += "\n";
    for (const ComparedTable::Row& row : table.rows)
      text += MarkdownRow(ComparisonCells(table, row));
    text += "\n";
  }
  for (const PrintedStatement& s : comparison.statements) {
    text += fmt::format("- {}, {}: {}\n", s.paper, s.where, s.text);
  }
  return text;
}

std::string FormatComparisonHtml(const PaperComparison& comparison) {
  if (comparison.tables.empty() && comparison.statements.empty()) return "";
  std::string html = "<h2>Beside the paper</h2>\n";
  for (const ComparedTable& table : comparison.tables) {
    html += fmt::format("<h3>{}</h3>\n", EscapeHtml(table.title));
    if (!table.note.empty()) {
      html += fmt::format("<p class=\"note\">{}</p>\n", EscapeHtml(table.note));
    }
    html += "<div class=\"scroll\"><table>\n<thead>" + HtmlRow(ComparisonHeader(table), "th") +
            "</thead>\n<tbody>\n";
    for (const ComparedTable::Row& row : table.rows)
      html += HtmlRow(ComparisonCells(table, row), "td");
    html += "</tbody></table></div>\n";
  }
  if (comparison.statements.empty()) return html;
  html += "<ul>\n";
  for (const PrintedStatement& s : comparison.statements) {
    html += fmt::format(
        "<li>{}, {}: {}</li>\n", EscapeHtml(s.paper), EscapeHtml(s.where), EscapeHtml(s.text));
  }
  return html + "</ul>\n";
}

}  // namespace plumbline
