// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/map_file/map_io.h"
#include "plumbline/io/trajectory_io.h"

#include "tests/io/scratch_folder.h"
#include "tests/lab/experiments/experiment_fixtures.h"
#include "tests/support/true_map.h"
#include <sstream>
#include <string>
#include <vector>

namespace plumbline {

inline constexpr int kFrames = 30;

// A row of trajectory_covariance.txt with this variance of all six numbers.
inline std::string CovarianceRow(std::int64_t stamp_ns, double variance) {
  std::ostringstream row;
  row << FormatStamp(stamp_ns);
  for (int i = 0; i < 36; ++i) row << ' ' << (i % 7 == 0 ? variance : 0);
  return row.str() + '\n';
}

// Writes a sequence `s` of 1.5 s with its true lines, and a run `run` that knows all poses, in
// another world, and whose every frame is a keyframe with noise as its features promise.
inline void WriteConsistentRun(const ScratchFolder& folder) {
  WriteSequenceFolder(folder, "s");
  const SyntheticWorld world = MakeSyntheticWorld(100, 60);
  std::vector<Rigid3> poses;
  Trajectory estimate;
  std::string truth, covariances, lines = "#x1,y1,z1,x2,y2,z2\n";
  for (int k = 0; k < kFrames; ++k) {
    const Rigid3 pose = Inverse(PoseOnPath(k));
    const std::int64_t stamp = std::int64_t{50'000'000} * k;
    std::ostringstream row;
    row.precision(17);
    row << stamp << ',' << pose.translation.x() << ',' << pose.translation.y() << ','
        << pose.translation.z() << ',' << pose.rotation.w() << ',' << pose.rotation.x() << ','
        << pose.rotation.y() << ',' << pose.rotation.z() << '\n';
    truth += row.str();
    covariances += CovarianceRow(stamp, 1e-4);
    estimate.push_back({stamp, Rigid3{Eigen::Quaterniond::Identity(), {1, 2, 3}} * pose});
    poses.push_back(PoseOnPath(k));
  }
  for (const auto& line : world.lines) {
    std::ostringstream row;
    row.precision(17);
    const auto& [start, end] = line.segment;
    row << start.x() << ',' << start.y() << ',' << start.z() << ',' << end.x() << ',' << end.y()
        << ',' << end.z() << '\n';
    lines += row.str();
  }
  folder.Write("s/mav0/state_groundtruth_estimate0/data.csv", truth);
  folder.Write("s/lines.csv", lines);
  folder.Write("run/summary.json", Summary(0.01));
  folder.Write("run/trajectory_covariance.txt", covariances);
  WriteTum(folder / "run/trajectory.txt", estimate);
  WriteTum(folder / "run/trajectory_causal.txt", estimate);
  SaveMap(folder / "run/map.plb",
          world.camera,
          Eigen::Quaterniond::Identity(),
          MakeTrueMap(world, poses, {}).map);
}

}  // namespace plumbline
