// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/matching/line_matching.h"

#include "plumbline/geometry/se3.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

TEST(LineMatchingOf, ChangesNothingUnlessAsked) {
  const Eigen::Quaterniond turned = ExpSo3({0, 5 * kDegree, 0});
  const LineMatchOptions usual;
  const LineMatchOptions options = LineMatchingOf({}, turned);
  EXPECT_EQ(options.min_length_ratio, usual.min_length_ratio);
  EXPECT_EQ(options.max_angle_deg, usual.max_angle_deg);
}

// A line of 100 px, and one of 70 px turned by 8 degrees about its middle.
TEST(LineMatchingOf, RefusesOtherLengthsAndMoreTurnThanTheCameras) {
  const Segment2 a{{100, 100}, {200, 100}};
  const Eigen::Vector2d half = 35 * Eigen::Vector2d(std::cos(8 * kDegree), std::sin(8 * kDegree));
  const Segment2 b{a.Midpoint() - half, a.Midpoint() + half};
  const Eigen::Quaterniond little = ExpSo3({0, 5 * kDegree, 0});
  const Eigen::Quaterniond much = ExpSo3({0, 9 * kDegree, 0});
  const Eigen::Quaterniond very_much = ExpSo3({0, 0, 90 * kDegree});
  EXPECT_TRUE(LinesCompatible(a, b, LineMatchingOf({}, little)));
  LineOptions lengths;
  lengths.min_length_ratio = 0.8;
  EXPECT_FALSE(LinesCompatible(a, b, LineMatchingOf(lengths, much)));
  LineOptions gate;
  gate.rotation_gate = true;
  EXPECT_FALSE(LinesCompatible(a, b, LineMatchingOf(gate, little)));
  EXPECT_TRUE(LinesCompatible(a, b, LineMatchingOf(gate, much)));
  EXPECT_TRUE(LinesCompatible(a, b, LineMatchingOf(gate))) << "rotation not known";
  EXPECT_EQ(LineMatchingOf(gate, very_much).max_angle_deg, LineMatchOptions{}.max_angle_deg);
}

}  // namespace
}  // namespace plumbline
