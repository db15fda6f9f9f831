// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/printed_figures.h"

#include "lab/experiments/catalog.h"
#include "lab/experiments/computed.h"
#include "lab/experiments/metrics.h"
#include "lab/experiments/paper_catalog.h"

#include "tests/io/scratch_folder.h"
#include <algorithm>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

const PrintedCell& CellOf(const PrintedTable& table,
                          const std::string& sequence,
                          const std::string& variant) {
  const auto row = std::find_if(
      table.rows.begin(), table.rows.end(), [&](auto& r) { return r.sequence == sequence; });
  const auto column = std::find(table.variants.begin(), table.variants.end(), variant);
  return row->cells.at(static_cast<std::size_t>(column - table.variants.begin()));
}

TEST(PrintedFigures, AreThoseOfThePapers) {
  const PrintedFigures one = PrintedFiguresOf("rippl-table1");
  ASSERT_EQ(one.tables.size(), 2U);
  EXPECT_EQ(one.tables[0].rows.size(), 8U);
  EXPECT_EQ(one.tables[0].unit, "cm");
  EXPECT_EQ(CellOf(one.tables[0], "fr2_desk", "conventional").value, 4.6942);
  EXPECT_EQ(CellOf(one.tables[1], "fr2_desk", "proposed").value, 6.7241);
  EXPECT_EQ(CellOf(one.tables[0], "fr3_nstr_tex_far", "conventional").value, std::nullopt);
  EXPECT_EQ(CellOf(one.tables[0], "fr3_nstr_tex_far", "conventional").text, "ambiguity");
  const PrintedFigures three = PrintedFiguresOf("cutting-table2-3");
  ASSERT_EQ(three.tables.size(), 2U);
  EXPECT_EQ(CellOf(three.tables[0], "V2_03_difficult", "PL+Cut").value, 0.364);
  EXPECT_EQ(CellOf(three.tables[1], "V1_02_medium blurred", "ORB2").value, 2.63);
  EXPECT_EQ(CellOf(three.tables[1], "V2_03_difficult blurred", "L").text, "-");
}

TEST(PrintedFigures, BelongToExperimentsSequencesVariantsAndMetricsThatThereAre) {
  for (const EmbeddedYaml& file : PrintedFiles()) {
    const PrintedFigures all = ParsePrintedFigures(file);
    for (const PrintedTable& table : all.tables) {
      const Experiment& experiment = FindExperiment(table.experiment);
      const Metric* metric = FindMetric(table.metric);
      ASSERT_NE(metric, nullptr) << table.metric;
      EXPECT_TRUE(UnitFactor(table.unit, metric->unit).has_value()) << table.unit;
      std::set<std::string> sequences, variants;
      for (const SequenceChoice& choice : experiment.sequences) sequences.insert(choice.paper);
      for (const Variant& variant : experiment.variants) variants.insert(variant.name);
      for (const PrintedRow& row : table.rows) {
        EXPECT_TRUE(sequences.contains(row.sequence)) << table.experiment << " " << row.sequence;
      }
      for (const std::string& variant : table.variants) {
        const bool other_system = variant == "ORB2" || variant == "SVO2";
        EXPECT_TRUE(other_system || variants.contains(variant)) << variant;
      }
      EXPECT_THAT(table.where, HasSubstr("page"));
    }
    for (const PrintedStatement& statement : all.statements) {
      EXPECT_THAT(statement.where, HasSubstr("page"));
      if (FindComputedExperiment(statement.experiment) != nullptr) continue;
      EXPECT_NO_THROW(FindExperiment(statement.experiment));
    }
  }
}

TEST(PrintedFigures, EveryExperimentOfAPaperHasSome) {
  for (const std::string& name : FindExperimentGroup("all")->experiments) {
    const PrintedFigures printed = PrintedFiguresOf(name);
    EXPECT_GT(printed.tables.size() + printed.statements.size(), 0U) << name;
  }
}

TEST(PrintedFigures, OtherTextIsRefusedWithItsPlace) {
  const auto message = [](const char* text) {
    return MessageOf([&] { ParsePrintedFigures({"file.yaml", text}); });
  };
  EXPECT_THAT(message("paper: P\ntabels: []\n"), HasSubstr("file.yaml:2: unknown key tabels"));
  const std::string head =
      "paper: P\ntables:\n  - experiment: e\n    where: w\n    metric: ate\n    unit: cm\n";
  EXPECT_THAT(message((head + "    variants: [a, b]\n    rows:\n      s: [1]\n").c_str()),
              HasSubstr("file.yaml:9: expected 2 cells, one a variant, found 1"));
  EXPECT_THAT(message("tables: []\n"), HasSubstr("file.yaml:1: expected paper:"));
  EXPECT_THAT(message("paper: [\n"), HasSubstr("file.yaml:"));
}

TEST(UnitFactor, KnowsLengthsAndWhatIsTheSame) {
  EXPECT_EQ(UnitFactor("cm", "mm"), 10);
  EXPECT_EQ(UnitFactor("m/s", "m/s"), 1);
  EXPECT_FALSE(UnitFactor("cm", "m/s").has_value());
}

}  // namespace
}  // namespace plumbline
