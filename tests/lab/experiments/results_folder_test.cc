// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/results_folder.h"

#include "lab/experiments/figure_list.h"
#include "lab/experiments/group_report.h"
#include "lab/experiments/write_results.h"
#include "plumbline/base/input_file.h"

#include "tests/io/scratch_folder.h"
#include "tests/lab/experiments/experiment_fixtures.h"
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace results_folder_test {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

TEST(ResultsFolder, RefusesFilesOfOthersThatTablesWouldReplace) {
  for (const char* name : {"results.json",
                           "timing.json",
                           "table.md",
                           "timing.md",
                           "table.html",
                           "ratios.json",
                           "starts.csv",
                           "gate.md",
                           "plots/mine.svg"}) {
    const ScratchFolder folder;
    const fs::path file = folder.Write(std::string("out/") + name, "mine\n");
    const std::string message = MessageOf([&] { CheckResultsFolder(folder / "out"); });
    EXPECT_THAT(message, StartsWith(file.string() + ": not written by an earlier experiment"));
    EXPECT_THAT(message, HasSubstr("choose another --out"));
    EXPECT_EQ(ReadInputFile(file), "mine\n");
  }
}

TEST(ResultsFolder, AForeignListOfFiguresMakesNoFolderOurs) {
  const ScratchFolder folder;
  folder.Write("out/results.json", "[{\"accuracy\": 0.7}]\n");
  folder.Write("out/table.md", "mine\n");
  EXPECT_THAT(MessageOf([&] { CheckResultsFolder(folder / "out"); }),
              HasSubstr("results.json: not written by an earlier experiment"));
}

TEST(ResultsFolder, WhatStandsApartIsNobodysBusiness) {
  const ScratchFolder folder;
  EXPECT_NO_THROW(CheckResultsFolder(folder / "none"));
  folder.Write("out/notes.md", "mine\n");
  folder.Write("out/plots/notes.txt", "mine\n");
  EXPECT_NO_THROW(CheckResultsFolder(folder / "out"));
}

TEST(ResultsFolder, TablesOfAnEarlierCallMayBeReplaced) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  WriteResults(plan, SomeResults());
  EXPECT_NO_THROW(CheckResultsFolder(plan.out));
  // Killed after its first file.
  folder.Write("begun/results.json", FormatFigureList("pair", SomeFigures()));
  folder.Write("begun/table.md", "of the call before\n");
  EXPECT_NO_THROW(CheckResultsFolder(folder / "begun"));
  folder.Write("empty/results.json", FormatFigureList("pair", {}));
  EXPECT_NO_THROW(CheckResultsFolder(folder / "empty"));
  fs::create_directories(folder / "group");
  WriteGroupReport(folder / "group", "both", "this and that", {});
  EXPECT_NO_THROW(CheckResultsFolder(folder / "group"));
}

}  // namespace results_folder_test
}  // namespace plumbline
