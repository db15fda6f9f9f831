// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/gate_run.h"

namespace plumbline {
namespace {

// Inline and lockstep give the same bytes (run_command_test), so one of them will do.
void Check(const Gate& gate) {
  const auto data = FindData(gate.sequence);
  if (!data) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  const nlohmann::json summary = Summary(gate, *data, "lockstep");
  ASSERT_FALSE(summary.is_null());
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
TEST(Accuracy, RoadDrivingStereo) { Check(kRoadDriving); }
TEST(Accuracy, MachineHallFastStereo) { Check(kMachineHallFast); }
TEST(Accuracy, MachineHallFastBackwardsStereo) { Check(kMachineHallFastBack); }
TEST(Accuracy, RoadFastStereo) { Check(kRoadFast); }
TEST(Accuracy, RoadFastTiedByLines) { Check(kRoadFastLines); }
TEST(Accuracy, MachineHallMono) { Check(kMachineHallMono); }
TEST(Accuracy, FloorMono) { Check(kFloorMono); }
TEST(Accuracy, OfficeMono) { Check(kOfficeMono); }
TEST(Accuracy, RoadMono) { Check(kRoadMono); }
TEST(Accuracy, RoadTurnMono) { Check(kRoadTurnMono); }
TEST(Accuracy, MachineHallWithLinesOnly) { Check(kMachineHallLines); }

}  // namespace
}  // namespace plumbline
