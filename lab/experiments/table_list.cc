// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/table_list.h"

#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson RowsOfTable(const Plan& plan, const ResultTable& table) {
  OrderedJson rows = OrderedJson::array();
  for (const TableRow& row : table.rows) {
    OrderedJson cells = OrderedJson::array();
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      cells.push_back(CellText(row, row.cells[c], *table.columns[c]));
    }
    rows.push_back({{"sequence", plan.sequences[row.sequence].name},
                    {"variant", plan.experiment.variants[row.variant].name},
                    {"runs", RunsText(row)},
                    {"cells", cells}});
  }
  return rows;
}

OrderedJson ColumnsOfTable(const ResultTable& table) {
  OrderedJson columns = OrderedJson::array();
  for (const Metric* metric : table.columns) {
    columns.push_back({{"metric", metric->name}, {"title", ColumnTitle(*metric)}});
  }
  return columns;
}

OrderedJson PrintedTables(const PaperComparison& comparison) {
  OrderedJson tables = OrderedJson::array();
  for (const ComparedTable& table : comparison.tables) {
    OrderedJson rows = OrderedJson::array();
    for (const ComparedTable::Row& row : table.rows) rows.push_back(ComparisonCells(table, row));
    tables.push_back({{"metric", table.metric},
                      {"title", table.title},
                      {"note", table.note},
                      {"header", ComparisonHeader(table)},
                      {"rows", rows}});
  }
  return tables;
}

}  // namespace

std::string FormatTableList(const Plan& plan,
                            const ResultTable& table,
                            const PaperComparison& comparison) {
  const OrderedJson json = {
      {"help", plan.experiment.help},
      {"centre", CentreOf(plan.experiment) == Centre::kMean ? "mean" : "median"},
      {"columns", ColumnsOfTable(table)},
      {"rows", RowsOfTable(plan, table)},
      {"printed", PrintedTables(comparison)},
      {"missing", plan.missing},
      {"failures", FailureTexts(plan, table)}};
  return json.dump(1, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

}  // namespace plumbline
