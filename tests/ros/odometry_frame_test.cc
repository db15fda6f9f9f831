// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "ros/odometry_frame.h"

#include <cmath>

#include <gtest/gtest.h>

namespace plumbline::ros_node {
namespace {

constexpr std::int64_t kInterval = 100'000'000;  // ns

// A robot that drives a curve at 1 m/s and turns by 0.2 rad/s.
Rigid3 OnTheCurve(int frame) {
  Vector6d speed;
  speed << 0, 0, 0.2, 1, 0, 0;
  return ExpSe3(speed * 0.1 * frame);
}

double Distance(const Rigid3& a, const Rigid3& b) { return LogSe3(Inverse(a) * b).norm(); }

TEST(OdometryFrame, IsTheMapUntilSomethingIsCorrected) {
  OdometryFrame odometry;
  for (int i = 0; i < 10; ++i) {
    const BasePose& pose = odometry.Next(kInterval * i, 0, OnTheCurve(i), false);
    EXPECT_LT(Distance(pose.odom_from_base, OnTheCurve(i)), 1e-12);
    EXPECT_LT(LogSe3(pose.MapFromOdom()).norm(), 1e-12);
    if (i == 0) continue;
    EXPECT_LT((pose.linear - Eigen::Vector3d(1, 0, 0)).norm(), 1e-9);
    EXPECT_LT((pose.angular - Eigen::Vector3d(0, 0, 0.2)).norm(), 1e-9);
  }
}

TEST(OdometryFrame, GoesOnWhereTheMapJumps) {
  // The correction shows in the frame that it is told with, or in the next one.
  for (const int shows : {5, 6}) {
    OdometryFrame odometry;
    Vector6d jump;
    jump << 0.1, 0, 0.3, 2, -1, 0.5;
    for (int i = 0; i < 12; ++i) {
      const Rigid3 in_map = i < shows ? OnTheCurve(i) : ExpSe3(jump) * OnTheCurve(i);
      const BasePose& pose = odometry.Next(kInterval * i, 0, in_map, i == 5);
      EXPECT_LT(Distance(pose.odom_from_base, OnTheCurve(i)), 1e-9) << shows << " " << i;
      EXPECT_LT(Distance(pose.MapFromOdom() * pose.odom_from_base, in_map), 1e-12);
    }
  }
}

TEST(OdometryFrame, GoesOnInAnotherMap) {
  OdometryFrame odometry;
  for (int i = 0; i < 10; ++i) {
    const bool other = i >= 5;
    const Rigid3 in_map = other ? Inverse(OnTheCurve(5)) * OnTheCurve(i) : OnTheCurve(i);
    const BasePose& pose = odometry.Next(kInterval * i, other ? 1 : 0, in_map, false);
    EXPECT_LT(Distance(pose.odom_from_base, OnTheCurve(i)), 1e-9) << i;
  }
}

TEST(OdometryFrame, StaysWhereItIsWhenStampsGoBackOrRepeat) {
  for (const std::int64_t stamp : {std::int64_t{0}, 4 * kInterval}) {
    OdometryFrame odometry;
    for (int i = 0; i < 5; ++i) odometry.Next(kInterval * i, 0, OnTheCurve(i), false);
    const BasePose& pose = odometry.Next(stamp, 0, OnTheCurve(0), true);
    EXPECT_LT(Distance(pose.odom_from_base, OnTheCurve(4)), 1e-12) << stamp;
    EXPECT_EQ(pose.linear.norm(), 0) << stamp;
    EXPECT_EQ(pose.angular.norm(), 0) << stamp;
  }
}

TEST(OdometryFrame, StandsStillWhereNothingIsKnownForLong) {
  OdometryFrame odometry;
  for (int i = 0; i < 5; ++i) odometry.Next(kInterval * i, 0, OnTheCurve(i), false);
  const BasePose& pose = odometry.Next(kInterval * 30, 1, Rigid3(), false);
  EXPECT_LT(Distance(pose.odom_from_base, OnTheCurve(4)), 1e-9);
  EXPECT_EQ(pose.linear.norm(), 0);
}

}  // namespace
}  // namespace plumbline::ros_node
