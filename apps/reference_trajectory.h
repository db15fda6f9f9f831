// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/trajectory.h"
#include "plumbline/io/trajectory_io.h"

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// What the poses of a reference file are about.
enum class ReferenceFrame { kCamera, kBody };
constexpr auto EnumNames(std::type_identity<ReferenceFrame>) {
  return std::array{std::pair{ReferenceFrame::kCamera, "camera"},
                    std::pair{ReferenceFrame::kBody, "body"}};
}

struct ReferenceTrajectory {
  Trajectory poses;  // of the left camera
  TrajectoryFormat format = TrajectoryFormat::kTum;
  std::optional<std::size_t> frames;  // images of the sequence beside it, where they are listed
  std::filesystem::path path;         // the file that was read
  std::vector<std::string> notes;     // which of its rows are left out
};

// Reads ground truth from a file (TUM form, EuRoC csv, KITTI poses) or from the folder of a data
// set that has it.
//
// `frame` says what the poses are about; nullopt: the body for EuRoC, else the camera. Poses of a
// body are converted with cam0/sensor.yaml of the same recording. Rows that cannot be used are left
// out (BadRows::kLeaveOut). Throws InputError where there is no ground truth, no row of it that can
// be used, or a body without that file.
ReferenceTrajectory LoadReference(const std::filesystem::path& path,
                                  std::optional<ReferenceFrame> frame);

// Number of frames a run was given, from the frames.csv beside its trajectory; nullopt without one,
// and where the manifest beside it (RunManifest) does not list the trajectory.
std::optional<std::size_t> FramesOfRun(const std::filesystem::path& trajectory);

// Whether the summary.json beside a trajectory says that it is that of a single camera, whose scale
// is free; false without one, and where the manifest beside it does not list the trajectory.
bool IsMonocularRun(const std::filesystem::path& trajectory);

}  // namespace plumbline
