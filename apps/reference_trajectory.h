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

// Frame of the poses of a reference file.
enum class ReferenceFrame { kCamera, kBody };
constexpr auto EnumNames(std::type_identity<ReferenceFrame>) {
  return std::array{std::pair{ReferenceFrame::kCamera, "camera"},
                    std::pair{ReferenceFrame::kBody, "body"}};
}

struct ReferenceTrajectory {
  Trajectory poses;  // of the left camera
  TrajectoryFormat format = TrajectoryFormat::kTum;
  std::optional<std::size_t> frames;  // images of the sequence beside it, if listed
  std::filesystem::path path;         // the file that was read
  std::vector<std::string> notes;     // rows left out
};

// Reads ground truth from a file (TUM form, EuRoC csv, KITTI poses) or from the folder of a data
// set.
//
// `frame` is the frame of the poses; nullopt: the body for EuRoC, otherwise the camera. Poses of a
// body are converted with cam0/sensor.yaml of the same recording. Unusable rows are left out
// (BadRows::kLeaveOut). Throws InputError without ground truth, without usable rows, or for a body
// without that file.
ReferenceTrajectory LoadReference(const std::filesystem::path& path,
                                  std::optional<ReferenceFrame> frame);

// Returns the number of frames given to a run, from the frames.csv beside its trajectory; nullopt
// without one, and if the list beside it (kRunList) does not list the trajectory.
std::optional<std::size_t> FramesOfRun(const std::filesystem::path& trajectory);

// Returns true if the summary.json beside a trajectory says that it is of a single camera, with
// arbitrary scale; false without one, and if the manifest beside it does not list the trajectory.
bool IsMonocularRun(const std::filesystem::path& trajectory);

}  // namespace plumbline
