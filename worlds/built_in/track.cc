// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/built_in/track.h"

#include "plumbline/base/elementary.h"

#include <cmath>
#include <numbers>

namespace plumbline {

Rigid3 Track::At(double time) const {
  using Eigen::Vector2d;
  constexpr double kPi = std::numbers::pi;
  const auto pose = [this](const Vector2d& at, double yaw) -> Rigid3 {
    const double ahead = speed < 0 ? yaw + kPi : yaw;
    return {ExpSo3(ahead * Eigen::Vector3d::UnitZ()), {at.x(), at.y(), z}};
  };
  const Vector2d straight = 2 * (half.array() - radius);
  const double corner = 0.5 * kPi * radius;
  const double round = 2 * (straight.sum() + 2 * corner);
  double s = std::fmod(start + speed * time, round);
  if (s < 0) s += round;
  // The four sides, each with the corner after it, start at the lower left.
  double yaw = 0;
  Vector2d at = centre - half + Vector2d(radius, 0);
  for (int side = 0; side < 4; ++side, yaw += 0.5 * kPi) {
    const double length = straight(side % 2);
    const Vector2d ahead(math::Cos(yaw), math::Sin(yaw)), left(-ahead.y(), ahead.x());
    if (s <= length) return pose(at + s * ahead, yaw);
    s -= length;
    at += length * ahead;
    if (s <= corner) {
      const double angle = s / radius;
      return pose(at + radius * (math::Sin(angle) * ahead + (1 - math::Cos(angle)) * left),
                  yaw + angle);
    }
    s -= corner;
    at += radius * (ahead + left);
  }
  return pose(at, 0);
}

}  // namespace plumbline
