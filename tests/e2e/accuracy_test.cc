// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/gate_run.h"

namespace plumbline {
namespace {

void Check(const Gate& gate) {
  const auto data = FindData(gate.sequence);
  if (!data) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  CheckGate(gate, *data);
}

TEST(Accuracy, MachineHallStereo) { Check(kMachineHall); }
TEST(Accuracy, FloorRgbd) { Check(kFloor); }
TEST(Accuracy, RoadStereo) { Check(kRoad); }
TEST(Accuracy, RoadDrivingStereo) { Check(kRoadDriving); }
TEST(Accuracy, MachineHallFastStereo) { Check(kMachineHallFast); }
TEST(Accuracy, RoadFastStereo) { Check(kRoadFast); }
TEST(Accuracy, RoadFastTiedByLines) { Check(kRoadFastLines); }
TEST(Accuracy, MachineHallMono) { Check(kMachineHallMono); }
TEST(Accuracy, FloorMono) { Check(kFloorMono); }
TEST(Accuracy, OfficeMono) { Check(kOfficeMono); }
TEST(Accuracy, RoadMono) { Check(kRoadMono); }
TEST(Accuracy, RoadTurnMono) { Check(kRoadTurnMono); }
TEST(Accuracy, RoadLensMono) { Check(kRoadLensMono); }
TEST(Accuracy, MachineHallWithLinesOnly) { Check(kMachineHallLines); }

}  // namespace
}  // namespace plumbline
