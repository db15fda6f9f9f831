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

// Against samples of the camera's error, put through the poses that are published.
TEST(OdometryFrame, CovarianceOfTheBaseFollowsFromThatOfTheCamera) {
  Vector6d mounting, place, correction;
  mounting << 0.3, -1.2, 0.5, 0.4, -0.1, 0.8;
  place << -0.7, 0.2, 1.1, 3, -2, 1;
  correction << 0.1, 0.2, -0.6, 5, 1, -2;
  const Rigid3 base_from_camera = ExpSe3(mounting), world_from_camera = ExpSe3(place);
  BasePose pose;
  pose.map_from_base = base_from_camera * world_from_camera * Inverse(base_from_camera);
  const Rigid3 odom_from_map = ExpSe3(correction);
  pose.odom_from_base = odom_from_map * pose.map_from_base;
  Matrix6d J;  // of the base's [x, y, z, rotation] by that of the camera
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 6; ++i) {
    const Vector6d step = kStep * Vector6d::Unit(i);
    const Rigid3 moved_camera{ExpSo3(step.tail<3>()) * world_from_camera.rotation,
                              world_from_camera.translation + step.head<3>()};
    const Rigid3 moved =
        odom_from_map * base_from_camera * moved_camera * Inverse(base_from_camera);
    J.col(i) << (moved.translation - pose.odom_from_base.translation) / kStep,
        LogSo3(moved.rotation * pose.odom_from_base.rotation.conjugate()) / kStep;
  }
  const Matrix6d root = Matrix6d::Random();
  const Matrix6d covariance = root * root.transpose();
  const Matrix6d expected = J * covariance * J.transpose();
  const Matrix6d found = BaseCovariance(pose, base_from_camera, world_from_camera, covariance);
  EXPECT_LT((found - expected).norm(), 1e-4 * expected.norm());
  EXPECT_EQ(found, found.transpose());
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
