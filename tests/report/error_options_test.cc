// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/error_options.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(ErrorOptions, LeaveTheScaleOfASingleCameraFree) {
  for (const DatasetFormat format : {DatasetFormat::kEuroc, DatasetFormat::kKitti}) {
    EXPECT_EQ(ErrorOptionsFor(SensorKind::kMono, format).alignment, TrajectoryAlignment::kSim3);
    EXPECT_EQ(ErrorOptionsFor(SensorKind::kStereo, format).alignment, TrajectoryAlignment::kSe3);
    EXPECT_EQ(ErrorOptionsFor(SensorKind::kRgbd, format).alignment, TrajectoryAlignment::kSe3);
  }
}

TEST(ErrorOptions, AllowKittiLargerGaps) {
  for (const SensorKind sensor : {SensorKind::kMono, SensorKind::kStereo}) {
    EXPECT_EQ(ErrorOptionsFor(sensor, DatasetFormat::kKitti).max_gap_ns, 250'000'000);
    EXPECT_EQ(ErrorOptionsFor(sensor, DatasetFormat::kTum).max_gap_ns,
              TrajectoryErrorOptions{}.max_gap_ns);
  }
}

}  // namespace
}  // namespace plumbline
