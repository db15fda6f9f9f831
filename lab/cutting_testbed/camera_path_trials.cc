// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/cutting_testbed/camera_path_trials.h"

#include "lab/cutting_testbed/single_line_trials.h"

#include <algorithm>
#include <cstddef>
#include <numbers>

namespace plumbline {
namespace {

constexpr int kAngles = 19;

std::array<double, 3> Quartiles(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
  };
  return {at(0.25), at(0.5), at(0.75)};
}

}  // namespace

std::vector<CameraPathPoint> TryCameraPath(const SceneOptions& options, int scenes) {
  std::vector<CameraPathPoint> path;
  for (int i = 0; i < kAngles; ++i) {
    const double angle_deg = 90.0 * i / (kAngles - 1);
    std::vector<double> first, second;
    for (int s = 0; s < scenes; ++s) {
      const CuttingScene scene =
          MakeEdgeScene(options, angle_deg * std::numbers::pi / 180, static_cast<std::uint64_t>(s));
      const SingleLineTrial trial =
          TrySingleLines(scene, CuttingInformation::kIndependent, AscentStarts::kThree, 1).front();
      first.push_back(trial.grid.x());
      second.push_back(trial.grid.y());
    }
    path.push_back({angle_deg, Quartiles(first), Quartiles(second)});
  }
  return path;
}

}  // namespace plumbline
