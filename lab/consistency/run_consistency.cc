// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/consistency/run_consistency.h"

#include "lab/consistency/landmark_consistency.h"
#include "lab/consistency/motion_consistency.h"
#include "lab/consistency/residual_consistency.h"
#include "lab/line_maps/run_trajectory.h"
#include "plumbline/base/units.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/io/text_rows.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/report/error_options.h"
#include "worlds/true_world.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <system_error>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

bool Exists(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error);
}

// Reads rows of `seconds` and 36 numbers, as runs write them.
PoseCovariances ReadCovariances(const fs::path& file) {
  constexpr std::size_t kFields = 37;
  PoseCovariances covariances;
  for (const TextRow& row : ReadRows(file, ' ')) {
    if (row.fields.size() != kFields) {
      FailAt(file, row.line, "37 numbers", std::to_string(row.fields.size()));
    }
    const auto stamp_ns = ParseSeconds(row.fields[0]);
    if (!stamp_ns) FailAt(file, row.line, "a time in seconds", row.fields[0]);
    Matrix6d& covariance = covariances[*stamp_ns];
    for (Eigen::Index i = 0; i < covariance.size(); ++i) {
      covariance(i / 6, i % 6) = NumberField(file, row, static_cast<std::size_t>(i) + 1);
    }
  }
  return covariances;
}

KeyFramePoses PosesOf(const SavedMap& saved,
                      ConsistencyPoses which,
                      const Trajectory& truth,
                      std::int64_t max_gap_ns) {
  KeyFramePoses poses;
  const Rigid3 rectified_from_left{saved.rectified_from_left, Eigen::Vector3d::Zero()};
  for (const auto& [id, keyframe] : saved.map.keyframes()) {
    if (which == ConsistencyPoses::kRun) {
      poses[id] = keyframe.frame.cam_from_world;
    } else if (const auto pose = InterpolateAt(truth, keyframe.frame.stamp_ns, max_gap_ns)) {
      poses[id] = rectified_from_left * Inverse(*pose);
    }
  }
  return poses;
}

void Append(std::vector<ConsistencySample> from, std::vector<ConsistencySample>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

std::optional<std::vector<ConsistencySample>> ReadRunConsistency(const fs::path& sequence,
                                                                 const fs::path& run,
                                                                 ConsistencyPoses poses) {
  const auto compared = CompareRunWithTruth(sequence, run);
  if (!compared) return std::nullopt;
  DatasetOptions data_options;
  data_options.allow_missing_camera = true;
  const auto dataset = OpenDataset(sequence, data_options);
  const Trajectory truth = dataset->info().ground_truth->OfCamera(dataset->calibration());
  const std::int64_t max_gap_ns =
      ErrorOptionsFor(SensorKind::kStereo, dataset->info().format).max_gap_ns;
  const SavedMap saved = LoadMap(run / "map.plb");
  std::vector<ConsistencySample> samples =
      ResidualSamples(saved.map, saved.camera, PosesOf(saved, poses, truth, max_gap_ns));
  if (Exists(sequence / "lines.csv")) {
    const auto lines = ReadTrueLines(sequence / "lines.csv");
    std::vector<Parallelogram> surfaces;
    if (Exists(sequence / "surfaces.csv")) surfaces = ReadSurfaces(sequence / "surfaces.csv");
    const KeyFramePoses true_poses = PosesOf(saved, ConsistencyPoses::kTruth, truth, max_gap_ns);
    Append(LandmarkSamples(saved.map, saved.camera, true_poses, {lines, surfaces}), samples);
  }
  PromisedPoses promised{{},
                         ReadCovariances(run / "trajectory_covariance.txt"),
                         compared->reference_from_estimate.scale};
  for (const bool causal : {true, false}) {
    promised.poses =
        ReadTrajectory(run / (causal ? "trajectory_causal.txt" : "trajectory.txt")).poses;
    const auto add = [&](ConsistencyKind kind, std::int64_t seconds) {
      Append(MotionSamples(kind, promised, truth, max_gap_ns, seconds * kNsPerSecond), samples);
    };
    add(causal ? ConsistencyKind::kCausal1s : ConsistencyKind::kFinal1s, 1);
    add(causal ? ConsistencyKind::kCausal5s : ConsistencyKind::kFinal5s, 5);
  }
  return samples;
}

}  // namespace plumbline
