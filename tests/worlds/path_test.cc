// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/path.h"

#include "worlds/built_in/worlds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Vector3d;

const Vector3d kRoomSize(6.4, 5.2, 2.8);

// Highest speed [m/s], turn rate [rad/s] and accelerations of both on a path.
struct Motion {
  double speed = 0, turn = 0, acceleration = 0, turn_acceleration = 0;
};

Motion Measure(const CameraPath& path) {
  constexpr double kStep = 1e-3;
  Motion most;
  Vector6d last = Vector6d::Zero();
  for (double time = 0; time < path.duration; time += kStep) {
    const Rigid3 a = path.world_from_camera(time), b = path.world_from_camera(time + kStep);
    Vector6d velocity;
    velocity << LogSo3(a.rotation.conjugate() * b.rotation) / kStep,
        (b.translation - a.translation) / kStep;
    most.turn = std::max(most.turn, velocity.head<3>().norm());
    most.speed = std::max(most.speed, velocity.tail<3>().norm());
    if (time > 0) {
      const Vector6d change = (velocity - last) / kStep;
      most.turn_acceleration = std::max(most.turn_acceleration, change.head<3>().norm());
      most.acceleration = std::max(most.acceleration, change.tail<3>().norm());
    }
    last = velocity;
  }
  return most;
}

CameraPath Corner() {
  return SplinePath({{{0, 0, 1.5}, 0, 0, 0, 0},
                     {{4, 0, 1.5}, 0.5 * std::numbers::pi, 0.1, 0, 1},
                     {{4, 3, 1.5}, -3.0, 0, 0, 0}},
                    {1.0, 0.8});
}

TEST(CameraAttitude, LooksWhereItShould) {
  const Eigen::Matrix3d axes = CameraAttitude(0.5, 0.3, 0).toRotationMatrix();
  EXPECT_NEAR(std::atan2(axes(1, 2), axes(0, 2)), 0.5, 1e-12);
  EXPECT_NEAR(std::asin(-axes(2, 2)), 0.3, 1e-12);
  EXPECT_NEAR(axes(2, 0), 0, 1e-12);  // x level
  EXPECT_LT(axes(2, 1), 0);           // y down
  // Clockwise about the line of sight: the right side goes down.
  EXPECT_LT(CameraAttitude(0.5, 0.3, 0.2).toRotationMatrix()(2, 0), -0.1);
}

TEST(SplinePath, PassesNearTheWaypointsAtThePace) {
  const CameraPath path = Corner();
  // 4 s, then the turn to 1.5 rad, a second's rest, and a turn of 1.71 rad the short way in 3 m.
  EXPECT_NEAR(path.duration, 4 + 1 + 3 + 1, 0.05);
  const Rigid3 begin = path.world_from_camera(0), end = path.world_from_camera(path.duration);
  EXPECT_LT((begin.translation - Vector3d(0, 0, 1.5)).norm(), 1e-9);
  EXPECT_LT((end.translation - Vector3d(4, 3, 1.5)).norm(), 1e-9);
  EXPECT_LT(AngularDistance(end.rotation, CameraAttitude(-3, 0, 0)), 1e-9);
  double nearest = 1;
  for (double time = 0; time < path.duration; time += 0.01) {
    nearest =
        std::min(nearest, (path.world_from_camera(time).translation - Vector3d(4, 0, 1.5)).norm());
  }
  EXPECT_LT(nearest, 0.05);
  const Motion motion = Measure(path);
  EXPECT_LT(motion.speed, 1.01);
  EXPECT_GT(motion.speed, 0.95);
  EXPECT_LT(motion.turn, 0.85);
}

TEST(SplinePath, StartsAndEndsAtRestWithoutJerks) {
  const CameraPath path = Corner();
  for (const double time : {0.0, path.duration}) {
    const Vector3d before = path.world_from_camera(time - 1e-3).translation;
    const Vector3d after = path.world_from_camera(time + 1e-3).translation;
    EXPECT_LT((after - before).norm() / 2e-3, 1e-4);
  }
  const Motion motion = Measure(path);
  EXPECT_LT(motion.acceleration, 4);
  EXPECT_LT(motion.turn_acceleration, 4);
}

TEST(WithCarrier, CarriersMoveAsTheyDo) {
  const CameraPath still = SplinePath({{{0, 0, 1}, 0, 0, 0, 10}}, {1, 1});
  const Motion hand = Measure(WithCarrier(still, Carrier::kHand, 1));
  EXPECT_GT(hand.speed, 0.05);
  EXPECT_LT(hand.speed, 0.4);
  EXPECT_LT(hand.turn, 0.5);
  const Motion wheels = Measure(WithCarrier(still, Carrier::kWheels, 1));
  EXPECT_LT(wheels.speed, 0.15);
  EXPECT_LT(wheels.turn, 0.3);
  const Motion car = Measure(WithCarrier(still, Carrier::kCar, 1));
  EXPECT_GT(car.turn, 0.01);
  EXPECT_LT(car.turn, 0.3);
  EXPECT_LT(car.speed, 0.3);
  const Motion tripod = Measure(WithCarrier(still, Carrier::kTripod, 1));
  EXPECT_LT(tripod.speed, 1e-9);
  // Other seeds sway otherwise.
  const Rigid3 a = WithCarrier(still, Carrier::kHand, 1).world_from_camera(3);
  const Rigid3 b = WithCarrier(still, Carrier::kHand, 2).world_from_camera(3);
  EXPECT_GT((a.translation - b.translation).norm(), 1e-4);
}

TEST(WithCarrier, ADroneLeansIntoItsAcceleration) {
  const CameraPath path = SplinePath({{{0, 0, 1}, 0, 0, 0, 1}, {{6, 0, 1}, 0, 0, 0, 0}}, {3, 1});
  const CameraPath drone = WithCarrier(path, Carrier::kDrone, 1);
  double most_down = 0, most_up = 0;
  for (double time = 0; time < path.duration; time += 0.02) {
    const double down = -drone.world_from_camera(time).rotation.toRotationMatrix()(2, 2);
    most_down = std::max(most_down, down);
    most_up = std::max(most_up, -down);
  }
  EXPECT_GT(most_down, 0.15);  // speeding up, nose down
  EXPECT_GT(most_up, 0.15);    // braking
}

TEST(Faster, TakesLessTimeOverTheSameWay) {
  const CameraPath path = Corner(), fast = Faster(path, 2);
  EXPECT_NEAR(fast.duration, 0.5 * path.duration, 1e-12);
  EXPECT_LT((fast.world_from_camera(1).translation - path.world_from_camera(2).translation).norm(),
            1e-12);
}

HandHeldLoop RoomLoop(std::uint64_t seed) {
  return HandHeldLoop({{0.5 * kRoomSize.x(), 0.5 * kRoomSize.y(), 1.5}, 1.1, 0.75, 10, seed});
}

TEST(HandHeldLoop, KeepsAwayFromEverything) {
  const Scene scene = MakeRoom(1).scene;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const HandHeldLoop loop = RoomLoop(seed);
    for (double time = 0; time < 10; time += 0.1) {
      const Vector3d position = loop.WorldFromCamera(time).translation;
      for (const Surface& surface : scene.surfaces) {
        ASSERT_GT(surface.DistanceTo(position), 0.5) << time;
      }
    }
  }
}

TEST(HandHeldLoop, ClosesAndIsSmooth) {
  constexpr double kStep = 1e-3;
  const HandHeldLoop loop = RoomLoop(1);
  const Rigid3 begin = loop.WorldFromCamera(0), end = loop.WorldFromCamera(10);
  EXPECT_LT((begin.translation - end.translation).norm(), 1e-9);
  EXPECT_LT(AngularDistance(begin.rotation, end.rotation), 1e-9);
  double fastest = 0, quickest_turn = 0;
  Vector6d last = Vector6d::Zero();
  for (int i = 0; i < 10'000; ++i) {
    const Rigid3 a = loop.WorldFromCamera(i * kStep), b = loop.WorldFromCamera((i + 1) * kStep);
    const Vector6d velocity = LogSe3(Inverse(a) * b) / kStep;
    fastest = std::max(fastest, velocity.tail<3>().norm());
    quickest_turn = std::max(quickest_turn, velocity.head<3>().norm());
    if (i > 0) {
      ASSERT_LT((velocity - last).norm() / kStep, 20) << i;  // no jumps
    }
    last = velocity;
  }
  EXPECT_GT(fastest, 0.5);
  EXPECT_LT(fastest, 1.5);
  EXPECT_LT(quickest_turn, 0.5 * std::numbers::pi);
}

TEST(HandHeldLoop, HoldsTheCameraUpright) {
  const HandHeldLoop loop = RoomLoop(1);
  for (double time = 0; time < 10; time += 0.1) {
    const Eigen::Matrix3d axes = loop.WorldFromCamera(time).rotation.toRotationMatrix();
    EXPECT_NEAR(axes.determinant(), 1, 1e-12);
    EXPECT_LT(axes(2, 1), -0.85);          // y of the camera points down
    EXPECT_LT(std::abs(axes(2, 2)), 0.5);  // and its view is near level
  }
}

}  // namespace
}  // namespace plumbline
