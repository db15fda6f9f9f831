// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/elementary.h"

#include <cmath>

namespace plumbline {

// The largest of many angles in [0, pi], each given by the two arguments of atan2. An angle is
// computed only if it may be the largest: atan2 takes ten times as long as that test.
class LargestAngle {
 public:
  // Adds an angle. Returns true if atan2(across, along) exceeds 0 and all earlier angles. Requires
  // across >= 0.
  bool Add(double across, double along) {
    // If two angles are nearly equal, the rounded angles decide.
    constexpr double kClearly = 1e-12;
    const double ahead = across * along_, behind = along * across_;
    if (ahead - behind < -kClearly * (std::abs(ahead) + std::abs(behind))) return false;
    const double angle = math::Atan2(across, along);
    if (!(angle > angle_)) return false;
    angle_ = angle;
    across_ = across;
    along_ = along;
    return true;
  }

  double angle() const { return angle_; }

 private:
  double angle_ = 0;
  double across_ = 0, along_ = 1;  // arguments of atan2 for angle_
};

}  // namespace plumbline
