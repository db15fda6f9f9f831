// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/rectified_camera.h"

#include "plumbline/geometry/se3.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/core.h>

namespace plumbline {

std::optional<std::string> CameraDifference(const TurnedCamera& a, const TurnedCamera& b) {
  constexpr double kRounding = 1e-9, kDegrees = 180 / std::numbers::pi;
  if (a.camera.width != b.camera.width || a.camera.height != b.camera.height) {
    return fmt::format("images of {}x{} and {}x{} pixels",
                       a.camera.width,
                       a.camera.height,
                       b.camera.width,
                       b.camera.height);
  }
  struct Number {
    const char* name;
    double a, b;
  };
  const Number numbers[] = {{"fx", a.camera.fx, b.camera.fx},
                            {"fy", a.camera.fy, b.camera.fy},
                            {"cx", a.camera.cx, b.camera.cx},
                            {"cy", a.camera.cy, b.camera.cy},
                            {"a baseline of", a.camera.baseline, b.camera.baseline}};
  for (const Number& number : numbers) {
    const double largest = std::max(std::abs(number.a), std::abs(number.b));
    if (!(std::abs(number.a - number.b) <= kRounding * largest)) {
      return fmt::format("{} {:.9g} and {:.9g}", number.name, number.a, number.b);
    }
  }
  const double angle = AngularDistance(a.rectified_from_left, b.rectified_from_left);
  if (angle <= kRounding) return std::nullopt;
  return fmt::format("rectified images turned by {:.3g} degrees against each other",
                     kDegrees * angle);
}

}  // namespace plumbline
