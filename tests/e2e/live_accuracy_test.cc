// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/gate_run.h"

namespace plumbline {
namespace {

// How many frames are dropped is up to the machine: plumbline experiment tells. With few,
// none may be lost, and the error must hold for those tracked.
void CheckLive(const Gate& gate) {
  const auto data = FindData(gate.sequence);
  if (!data) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  const nlohmann::json summary = Summary(gate, *data, "live");
  ASSERT_FALSE(summary.is_null());
  const auto& frames = summary["frames"];
  EXPECT_EQ(frames["in"], gate.tracked + gate.skipped);
  const int dropped = frames["dropped"];
  if (dropped > gate.tracked / 5) {
    GTEST_SKIP() << "this machine is too slow, or too busy: " << dropped << " frames dropped";
  }
  EXPECT_EQ(frames["lost"], 0);
  EXPECT_EQ(frames["skipped"], gate.skipped + dropped);
  EXPECT_EQ(frames["tracked"], gate.tracked - dropped);
  EXPECT_EQ(summary["maps"], 1);
  ASSERT_FALSE(summary["accuracy"].is_null());
  EXPECT_LE(summary["accuracy"]["ate"]["rmse"], kLiveFactor * gate.max_ate_m);
}

TEST(LiveAccuracy, MachineHallStereo) { CheckLive(kMachineHall); }
TEST(LiveAccuracy, FloorRgbd) { CheckLive(kFloor); }
TEST(LiveAccuracy, RoadStereo) { CheckLive(kRoad); }

}  // namespace
}  // namespace plumbline
