// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/line_cutting/cut_lines.h"
#include "plumbline/optimization/residuals.h"

#include "tests/line_cutting/random_lines.h"

namespace plumbline {

// Points among the lines of RandomProblem, measured with 1 to 4 px; every other one has a
// disparity.
inline std::vector<PointRows> RandomPoints(std::uint64_t seed, int count) {
  const RectifiedCamera camera = TestCamera();
  Rng rng(seed, "points of a choice");
  std::vector<PointRows> points;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d place(rng.Uniform(-2, 2), rng.Uniform(-1.5, 1.5), rng.Uniform(2, 7));
    PointMeasurement measurement{camera.Project(place), rng.Uniform(1, 4), {}};
    if (i % 2 == 0) {
      measurement.disparity = Disparity{camera.fx * camera.baseline / place.z(), 1.0};
    }
    const auto residual = EvaluatePoint(camera, Rigid3{}, place, measurement);
    points.emplace_back(residual->J_pose.topRows(residual->rows));
  }
  return points;
}

}  // namespace plumbline
