// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"
#include "plumbline/matching/measurements.h"
#include "plumbline/optimization/residuals.h"

#include <cstddef>

namespace plumbline {

// Numbers of observations, by keyframe, and of those whose whitened residual is longer than 5 sigma
// in the left or the right image, or does not exist.
struct ObservationCount {
  int all = 0;
  int beyond = 0;

  double Share() const { return all == 0 ? 0 : static_cast<double>(beyond) / all; }
};
struct Misfits {
  ObservationCount points, lines;
};

inline Misfits CountMisfits(const Map& map, const RectifiedCamera& camera) {
  constexpr double kSigmas = 5;
  Misfits count;
  for (const auto& [id, point] : map.points()) {
    for (const auto& [keyframe, feature] : point.observations) {
      const Frame& frame = map.Find(keyframe)->frame;
      const auto residual =
          EvaluatePoint(camera,
                        frame.cam_from_world,
                        point.position,
                        MeasurePoint(frame.features(), static_cast<std::size_t>(feature)));
      ++count.points.all;
      count.points.beyond += !residual || !(residual->r.norm() <= kSigmas);
    }
  }
  for (const auto& [id, line] : map.lines()) {
    for (const auto& [keyframe, feature] : line.observations) {
      const Frame& frame = map.Find(keyframe)->frame;
      const auto agrees = [&](const LineMeasurement& measured) {
        const auto residual =
            EvaluateLine(camera, frame.cam_from_world, ToOrthonormal(line.line), measured);
        return residual && residual->r.norm() <= kSigmas;
      };
      const auto i = static_cast<std::size_t>(feature);
      const auto right = MeasureRightLine(frame.features(), i, LineWeighting::kCovariance);
      const bool good = agrees(MeasureLeftLine(frame.features(), i, LineWeighting::kCovariance)) &&
                        (!right || agrees(*right));
      ++count.lines.all;
      count.lines.beyond += !good;
    }
  }
  return count;
}

}  // namespace plumbline
