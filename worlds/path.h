// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Pose of a camera (x right, y down, z forward) in the world (z up) at any time in seconds: at
// least twice continuously differentiable, defined also slightly before 0 and after `duration`.
struct CameraPath {
  double duration = 0;  // seconds
  std::function<Rigid3(double time)> world_from_camera;
};

// Attitude of a camera looking along `yaw` (radians, from world x towards y) and down by `pitch`,
// rotated clockwise about its own axis by `roll`.
Eigen::Quaterniond CameraAttitude(double yaw, double pitch, double roll);

// A position on the path, and the viewing direction there.
struct Waypoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // world, metres
  double yaw = 0, pitch = 0, roll = 0;                 // radians as in CameraAttitude
  double pause = 0;                                    // stop, in seconds
};

struct Pace {
  double speed = 1;      // m/s, highest along straight pieces
  double turn_rate = 1;  // rad/s, highest change of yaw, pitch or roll
};

// A path along waypoints: each piece takes the time of its distance and rotation at the pace, and a
// cubic B-spline through time (uniform knots `knot_s` apart) rounds the corners, so that velocity
// and acceleration are continuous. Corners are cut by about speed * knot_s / 2. Yaw is taken the
// short way round from waypoint to waypoint; the camera starts and ends at rest.
CameraPath SplinePath(const std::vector<Waypoint>& waypoints,
                      const Pace& pace,
                      double knot_s = 0.5);

// Carrier of the camera, which adds small motions to the path.
enum class Carrier {
  kTripod,  // none
  kHand,    // steps, sway, a wandering gaze
  kDrone,   // drift, tilt into accelerations, vibration
  kWheels,  // vibration of a rolling cart, no sway
  kCar,     // pitch, roll and heave of its springs, and the road's unevenness
};

// Adds the motions of a carrier: sums of sines whose phases come from the seed.
CameraPath WithCarrier(CameraPath path, Carrier carrier, std::uint64_t seed);

// The same path, `factor` times as fast.
CameraPath Faster(CameraPath path, double factor);

// A camera carried by hand around an ellipse, looking outward: steps, sway and a wandering gaze on
// top. Smooth, and closed after `loop_s` seconds (the sway repeats with the loop).
class HandHeldLoop {
 public:
  struct Shape {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // world, metres
    double radius_x = 1.0, radius_y = 0.8;             // metres
    double loop_s = 10;                                // seconds for one turn
    std::uint64_t seed = 1;                            // of the phases of sway and gaze
  };

  explicit HandHeldLoop(const Shape& shape);

  Rigid3 WorldFromCamera(double time) const;
  CameraPath Path() const;

 private:
  // Sum of a few sines with whole numbers of periods in a loop.
  double Wander(double time, int channel, int first_period, double size) const;

  Shape shape_;
};

}  // namespace plumbline
