// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/lamp_light.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace plumbline {
namespace {

using Eigen::Vector3d;

// Near the corners of a lamp and its centre, as shares of its sides from the centre.
const std::array<Eigen::Vector2d, 5> kProbes = {Eigen::Vector2d(0, 0),
                                                Eigen::Vector2d(-0.45, -0.45),
                                                Eigen::Vector2d(0.45, -0.45),
                                                Eigen::Vector2d(-0.45, 0.45),
                                                Eigen::Vector2d(0.45, 0.45)};

// A place given as shares of the sides from the centre.
Vector3d At(const Lamp& lamp, const Eigen::Vector2d& place) {
  return lamp.centre + place.x() * lamp.side_u + place.y() * lamp.side_v;
}

// As LightFrom, at such a place.
LampPoint LightAt(const Lamp& lamp,
                  const Vector3d& position,
                  const Vector3d& point,
                  const Vector3d& normal) {
  const bool flat = !lamp.side_u.isZero();
  const Vector3d offset = position - point;
  const double distance = offset.norm();
  if (distance < 1e-6) return {position, 0};
  const double facing = normal.dot(offset) / distance;
  const double leaving =
      flat ? -lamp.side_u.cross(lamp.side_v).normalized().dot(offset) / distance : 1;
  if (facing <= 0 || leaving <= 0) return {position, 0};
  // A large lamp close by: no part of it gives more than it would from an eighth of its size.
  const double nearest = 0.0625 * (lamp.side_u.norm() + lamp.side_v.norm());
  const double squared = std::max(distance * distance, nearest * nearest);
  return {position, lamp.power * facing * leaving / squared};
}

}  // namespace

Vector3d PlaceOn(const Lamp& lamp, int number) {
  // A sequence of low discrepancy: any first n of it cover the lamp evenly.
  constexpr double kStepU = 0.7548776662466927, kStepV = 0.5698402909980532;
  const double u = 0.5 + kStepU * number, v = 0.5 + kStepV * number;
  return At(lamp, {u - std::floor(u) - 0.5, v - std::floor(v) - 0.5});
}

LampPoint LightFrom(const Lamp& lamp, int number, const Vector3d& point, const Vector3d& normal) {
  return LightAt(lamp, PlaceOn(lamp, number), point, normal);
}

double LightOfLamp(const Lamp& lamp,
                   const Vector3d& point,
                   const Vector3d& normal,
                   const RayTracer& tracer) {
  const auto seen = [&](const Vector3d& place) {
    return tracer.StillSees(point.cast<float>(), place.cast<float>(), kLampLift);
  };
  if (lamp.side_u.isZero()) {
    const LampPoint whole = LightFrom(lamp, 0, point, normal);
    return whole.light > 0 && seen(whole.position) ? whole.light : 0;
  }
  int seen_probes = 0;
  for (const Eigen::Vector2d& place : kProbes) {
    const LampPoint probe = LightAt(lamp, At(lamp, place), point, normal);
    seen_probes += probe.light > 0 && seen(probe.position) ? 1 : 0;
  }
  if (seen_probes == 0) return 0;
  double sum = 0;
  if (seen_probes < static_cast<int>(kProbes.size())) {
    for (int i = 0; i < kLampPoints; ++i) {
      const LampPoint part = LightFrom(lamp, i, point, normal);
      if (part.light > 0 && seen(part.position)) sum += part.light / kLampPoints;
    }
    return sum;
  }
  // All of it: an even grid, as fine as the distance asks for.
  const double size = lamp.side_u.norm() + lamp.side_v.norm();
  const int side = (lamp.centre - point).squaredNorm() > 9 * size * size ? 2 : 4;
  for (int i = 0; i < side * side; ++i) {
    const int row = i / side;
    const Eigen::Vector2d place((i % side + 0.5) / side - 0.5, (row + 0.5) / side - 0.5);
    sum += LightAt(lamp, At(lamp, place), point, normal).light / (side * side);
  }
  return sum;
}

}  // namespace plumbline
