// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/cutting_testbed/camera_path_trials.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(CameraPath, GoesFromEndOnToBroadsideWithQuartilesInOrder) {
  const auto path = TryCameraPath({SceneKind::kHomogeneousPoints, 0.005, 10}, 5);
  ASSERT_EQ(path.size(), 19U);
  EXPECT_EQ(path.front().angle_deg, 0);
  EXPECT_EQ(path.back().angle_deg, 90);
  for (const CameraPathPoint& point : path) {
    for (const auto& quartiles : {point.first, point.second}) {
      EXPECT_LE(quartiles[0], quartiles[1]);
      EXPECT_LE(quartiles[1], quartiles[2]);
    }
    EXPECT_LE(point.first[1], point.second[1]);
  }
  // End on, the near end is known best, and there is nothing to gain from length.
  EXPECT_GT(path.front().first[1], 0.9);
  EXPECT_LT(path.back().first[1], 0.6);
}

}  // namespace
}  // namespace plumbline
