// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/stereo_correction.h"

#include "tests/support/random_geometry.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(StereoCorrection, IsAQuadraticPolynomialAroundThePrincipalPoint) {
  const RectifiedCamera camera = TestCamera();
  Vector6d k;
  k << 0.1, -0.2, 0.3, -0.4, 0.5, -0.6;
  const StereoCorrection correction(camera, k);
  EXPECT_DOUBLE_EQ(correction.At({camera.cx, camera.cy}), 0.1);
  const double unit = 0.5 * camera.width;
  const double x = 0.7, y = -0.3;
  EXPECT_NEAR(correction.At({camera.cx + x * unit, camera.cy + y * unit}),
              0.1 - 0.2 * x + 0.3 * y - 0.4 * x * x + 0.5 * x * y - 0.6 * y * y,
              1e-12);
  EXPECT_NEAR(StereoCorrection::Terms(camera, {camera.cx + x * unit, camera.cy + y * unit}).dot(k),
              correction.At({camera.cx + x * unit, camera.cy + y * unit}),
              1e-12);
}

TEST(StereoCorrection, IsNothingByDefault) {
  const StereoCorrection none;
  EXPECT_EQ(none.At({100, 50}), 0);
  EXPECT_EQ(none, StereoCorrection());
}

}  // namespace
}  // namespace plumbline
