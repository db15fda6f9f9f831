// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/path.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"
#include "worlds/noise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

namespace plumbline {

namespace {

using Eigen::Vector3d;

constexpr double kTwoPi = 2 * std::numbers::pi;
using Vector6 = Vector6d;  // position, yaw, pitch, roll

// Waypoints with the times at which a traveller that turns on the spot passes them.
struct Schedule {
  std::vector<double> times;
  std::vector<Vector6> states;

  Vector6 At(double time) const {
    if (time <= times.front()) return states.front();
    if (time >= times.back()) return states.back();
    const auto after = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time) -
                                                times.begin());
    const double span = times[after] - times[after - 1];
    const double share = span > 0 ? (time - times[after - 1]) / span : 1;
    return states[after - 1] + share * (states[after] - states[after - 1]);
  }
};

Schedule MakeSchedule(const std::vector<Waypoint>& waypoints, const Pace& pace) {
  Schedule schedule;
  double time = 0;
  for (const Waypoint& waypoint : waypoints) {
    Vector6 state;
    state << waypoint.position, waypoint.yaw, waypoint.pitch, waypoint.roll;
    if (!schedule.states.empty()) {
      const Vector6& last = schedule.states.back();
      state(3) = last(3) + std::remainder(waypoint.yaw - last(3), kTwoPi);
      const Vector6 step = state - last;
      time += std::max(step.head<3>().norm() / pace.speed,
                       step.tail<3>().cwiseAbs().maxCoeff() / pace.turn_rate);
    }
    schedule.times.push_back(time);
    schedule.states.push_back(state);
    if (waypoint.pause > 0) {
      time += waypoint.pause;
      schedule.times.push_back(time);
      schedule.states.push_back(state);
    }
  }
  return schedule;
}

// Sum of `count` sines between two frequencies with amplitudes falling as 1 / frequency; `size` is
// its standard deviation. A function of time, channel and seed alone.
double Sway(
    double time, std::uint64_t seed, int channel, double low_hz, double high_hz, double size) {
  constexpr int kCount = 5;
  double sum = 0, power = 0;
  for (int i = 0; i < kCount; ++i) {
    const double jitter = UnitFromHash(HashCell(channel, 2 * i, seed));
    const double hertz = low_hz * math::Pow(high_hz / low_hz, (i + jitter) / kCount);
    const double amplitude = low_hz / hertz;
    const double phase = kTwoPi * UnitFromHash(HashCell(channel, 2 * i + 1, seed));
    sum += amplitude * math::Sin(kTwoPi * hertz * time + phase);
    power += 0.5 * amplitude * amplitude;
  }
  return size * sum / std::sqrt(power);
}

// A small motion: translation in the world, rotation vector in the camera.
struct Nudge {
  Vector3d translation = Vector3d::Zero();
  Vector3d rotation = Vector3d::Zero();
};

struct Band {
  double low_hz, high_hz, metres, radians;
};

void AddBand(Nudge& nudge, double time, std::uint64_t seed, int channel, const Band& band) {
  for (int k = 0; k < 3; ++k) {
    nudge.translation(k) += Sway(time, seed, channel + k, band.low_hz, band.high_hz, band.metres);
    nudge.rotation(k) += Sway(time, seed, channel + 3 + k, band.low_hz, band.high_hz, band.radians);
  }
}

Nudge HandNudge(double time, std::uint64_t seed) {
  constexpr double kStepHz = 1.8;
  Nudge nudge;
  AddBand(nudge, time, seed, 0, {0.08, 0.6, 0.012, 0.025});  // sway and gaze
  AddBand(nudge, time, seed, 10, {2.5, 7, 0.0006, 0.0015});  // tremor
  const double phase = kTwoPi * UnitFromHash(MixBits(seed));
  const double step = kTwoPi * kStepHz * time + phase;
  nudge.translation.z() += 0.007 * math::Sin(step);
  nudge.rotation.x() += 0.003 * math::Sin(step + 1);
  nudge.rotation.z() += 0.004 * math::Sin(0.5 * step + 2);
  return nudge;
}

Nudge DroneNudge(const CameraPath& path, double time, std::uint64_t seed) {
  constexpr double kStep = 0.3, kGravity = 9.81, kMostTilt = 0.5;
  Nudge nudge;
  AddBand(nudge, time, seed, 0, {0.1, 0.8, 0.015, 0.012});
  AddBand(nudge, time, seed, 10, {18, 45, 0.0001, 0.0004});  // rotors
  // It tilts into its acceleration: forward nose down, sideways rolling.
  const Rigid3 now = path.world_from_camera(time);
  const Vector3d acceleration =
      (path.world_from_camera(time + kStep).translation - 2 * now.translation +
       path.world_from_camera(time - kStep).translation) /
      (kStep * kStep);
  const Vector3d in_camera = now.rotation.conjugate() * acceleration;
  nudge.rotation.x() -= kMostTilt * math::Tanh(in_camera.z() / (kGravity * kMostTilt));
  nudge.rotation.z() += kMostTilt * math::Tanh(in_camera.x() / (kGravity * kMostTilt));
  return nudge;
}

Nudge WheelsNudge(double time, std::uint64_t seed) {
  Nudge nudge;
  AddBand(nudge, time, seed, 0, {7, 22, 0.00025, 0.0007});
  AddBand(nudge, time, seed, 10, {0.5, 1.5, 0.0005, 0.0015});
  nudge.translation.head<2>() *= 0.3;
  return nudge;
}

Nudge CarNudge(double time, std::uint64_t seed) {
  Nudge nudge;
  AddBand(nudge, time, seed, 0, {0.4, 1.6, 0.008, 0.004});  // springs
  AddBand(nudge, time, seed, 10, {7, 14, 0.0006, 0.0005});  // tyres
  nudge.translation.head<2>() *= 0.3;
  return nudge;
}

}  // namespace

Eigen::Quaterniond CameraAttitude(double yaw, double pitch, double roll) {
  const Vector3d forward(
      math::Cos(yaw) * math::Cos(pitch), math::Sin(yaw) * math::Cos(pitch), -math::Sin(pitch));
  const Vector3d right(math::Sin(yaw), -math::Cos(yaw), 0);
  Eigen::Matrix3d axes;
  axes << right, forward.cross(right), forward;
  const Eigen::Quaterniond level(axes);
  const Eigen::Quaterniond turn = ExpSo3(roll * Vector3d::UnitZ());
  return (level * turn).normalized();
}

CameraPath SplinePath(const std::vector<Waypoint>& waypoints, const Pace& pace, double knot_s) {
  PLUMBLINE_CHECK(!waypoints.empty() && pace.speed > 0 && pace.turn_rate > 0 && knot_s > 0,
                  "waypoints and pace of a path");
  const Schedule schedule = MakeSchedule(waypoints, pace);
  const double end = schedule.times.back();
  const auto at = [schedule, knot_s](double time) -> Rigid3 {
    // Time 0 is one knot before the schedule's: there all control points that count are the first.
    const double place = time / knot_s - 1;
    const double before = std::floor(place);
    const double x = place - before, x2 = x * x, x3 = x2 * x;
    const double weights[4] = {(1 - 3 * x + 3 * x2 - x3) / 6,
                               (4 - 6 * x2 + 3 * x3) / 6,
                               (1 + 3 * x + 3 * x2 - 3 * x3) / 6,
                               x3 / 6};
    Vector6 state = Vector6::Zero();
    for (int i = 0; i < 4; ++i) state += weights[i] * schedule.At((before - 1 + i) * knot_s);
    return {CameraAttitude(state(3), state(4), state(5)), state.head<3>()};
  };
  return {end + 2 * knot_s, at};
}

CameraPath WithCarrier(CameraPath path, Carrier carrier, std::uint64_t seed) {
  if (carrier == Carrier::kTripod) return path;
  const double duration = path.duration;
  return {duration, [path = std::move(path), carrier, seed](double time) {
            Nudge nudge;
            switch (carrier) {
              case Carrier::kTripod:
                break;
              case Carrier::kHand:
                nudge = HandNudge(time, seed);
                break;
              case Carrier::kDrone:
                nudge = DroneNudge(path, time, seed);
                break;
              case Carrier::kWheels:
                nudge = WheelsNudge(time, seed);
                break;
              case Carrier::kCar:
                nudge = CarNudge(time, seed);
                break;
            }
            const Rigid3 base = path.world_from_camera(time);
            return Rigid3{(base.rotation * ExpSo3(nudge.rotation)).normalized(),
                          base.translation + nudge.translation};
          }};
}

CameraPath Faster(CameraPath path, double factor) {
  PLUMBLINE_CHECK(factor > 0, "speed of a path");
  const double duration = path.duration / factor;
  return {duration, [path = std::move(path), factor](double time) {
            return path.world_from_camera(factor * time);
          }};
}

HandHeldLoop::HandHeldLoop(const Shape& shape) : shape_(shape) {}

CameraPath HandHeldLoop::Path() const {
  return {shape_.loop_s, [loop = *this](double time) { return loop.WorldFromCamera(time); }};
}

double HandHeldLoop::Wander(double time, int channel, int first_period, double size) const {
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double phase = 2 * std::numbers::pi * UnitFromHash(HashCell(channel, i, shape_.seed));
    const double turns = (first_period * (i + 1) + i) * time / shape_.loop_s;
    sum += size / (1 + i) * math::Sin(2 * std::numbers::pi * turns + phase);
  }
  return sum;
}

Rigid3 HandHeldLoop::WorldFromCamera(double time) const {
  const double turn = 2 * std::numbers::pi * time / shape_.loop_s;
  // About 1.7 steps a second; an even number in a loop, for the roll goes left and right.
  const double steps = 2 * std::round(0.5 * 1.7 * shape_.loop_s);
  const double gait = steps * turn;
  Eigen::Vector3d position = shape_.centre;
  position.x() += shape_.radius_x * math::Cos(turn) + Wander(time, 0, 2, 0.03);
  position.y() += shape_.radius_y * math::Sin(turn) + Wander(time, 1, 2, 0.03);
  position.z() += Wander(time, 2, 2, 0.08) + 0.006 * math::Sin(gait);

  const double yaw = turn + 0.5 + Wander(time, 3, 2, 0.08);
  const double pitch = 0.14 + Wander(time, 4, 2, 0.06) + 0.003 * math::Sin(gait + 1);  // downwards
  const double roll = Wander(time, 5, 3, 0.03) + 0.003 * math::Sin(0.5 * gait + 2);
  return {CameraAttitude(yaw, pitch, roll), position};
}

}  // namespace plumbline
