// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/gates.h"
#include "tests/e2e/program.h"
#include "tests/support/data_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

void Check(const Gate& gate) {
  const auto data = FindData(gate.sequence);
  if (!data) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  const ScratchFolder folder;
  const Outcome outcome = RunProgram(
      folder,
      "run " + Quoted(*data) + " " + gate.settings + " --quiet --out " + Quoted(folder / "run"));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto summary = nlohmann::json::parse(Contents(folder / "run/summary.json"));
  const auto& frames = summary["frames"];
  EXPECT_EQ(frames["tracked"], gate.tracked);
  EXPECT_EQ(frames["skipped"], gate.skipped);
  EXPECT_EQ(frames["in"], gate.tracked + gate.skipped);
  EXPECT_EQ(summary["maps"], 1);
  ASSERT_FALSE(summary["accuracy"].is_null());
  EXPECT_GE(summary["accuracy"]["associated"], gate.tracked - 2);
  EXPECT_LE(summary["accuracy"]["ate"]["rmse"], gate.max_ate_m);
}

TEST(Accuracy, MachineHallStereo) { Check(kMachineHall); }
TEST(Accuracy, FloorRgbd) { Check(kFloor); }
TEST(Accuracy, RoadStereo) { Check(kRoad); }
TEST(Accuracy, MachineHallWithLinesOnly) { Check(kMachineHallLines); }

}  // namespace
}  // namespace plumbline
