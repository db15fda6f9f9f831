// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/rectified_camera.h"

#include "plumbline/geometry/se3.h"

#include "tests/support/random_geometry.h"
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {

namespace {

TEST(CameraDifference, IsNoneBetweenCamerasThatDifferByRounding) {
  const TurnedCamera camera{TestCamera(), ExpSo3({0.1, 0.02, -0.03})};
  TurnedCamera rounded = camera;
  rounded.camera.cx *= 1 + 1e-15;
  rounded.rectified_from_left.coeffs() *= -1;
  EXPECT_FALSE(CameraDifference(camera, camera));
  EXPECT_FALSE(CameraDifference(camera, rounded));
  TurnedCamera single = camera;
  single.camera.baseline = 0;
  EXPECT_FALSE(CameraDifference(single, single));
}

TEST(CameraDifference, NamesTheFirstNumberThatDiffers) {
  const TurnedCamera camera{TestCamera(), Eigen::Quaterniond::Identity()};
  std::vector<std::pair<TurnedCamera, std::string>> cases(5, {camera, ""});
  cases[0].first.camera.width = 640;
  cases[0].second = "images of 752x480 and 640x480 pixels";
  cases[1].first.camera.fx = 436.5;
  cases[1].second = "fx 435 and 436.5";
  cases[2].first.camera.cy += 1e-4;
  cases[2].second = "cy 252 and 252.0001";
  cases[3].first.camera.baseline = 0;
  cases[3].second = "a baseline of 0.11 and 0";
  cases[4].first.rectified_from_left = ExpSo3({0, 0.01, 0});
  cases[4].second = "rectified images turned by 0.573 degrees against each other";
  for (const auto& [other, difference] : cases) {
    EXPECT_EQ(CameraDifference(camera, other), difference);
  }
}

}  // namespace

}  // namespace plumbline
