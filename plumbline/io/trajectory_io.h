// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/trajectory.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace plumbline {

// How the rows of a trajectory file are written.
enum class TrajectoryFormat {
  kTum,    // `seconds tx ty tz qx qy qz qw`, blanks between, # comments
  kEuroc,  // CSV `nanoseconds,px,py,pz,qw,qx,qy,qz,...`; more columns are ignored
  kKitti,  // 12 numbers a row, a 3x4 matrix; times in a separate file
};

// A trajectory and the format of its file.
struct LoadedTrajectory {
  TrajectoryFormat format = TrajectoryFormat::kTum;
  // Poses of the frame that the file is about, in order of time.
  Trajectory poses;
};

// Reads a trajectory and finds out its format from the first row. KITTI rows take their times from
// times.txt beside the file or, as distributed (poses/06.txt), ../sequences/06/times.txt.
// Quaternions are normalized. Throws InputError "path:line: expected ..., found ..." for a
// quaternion whose norm differs from 1 by more than 0.01, a matrix that is not a rotation (to
// 1e-3), times that do not increase, a file without rows, and any malformed row.
LoadedTrajectory ReadTrajectory(const std::filesystem::path& path);

// Reads the rows of a KITTI poses file, with one time stamp for each. Throws the errors of
// ReadTrajectory, and InputError where there are more or fewer rows than stamps.
Trajectory ReadKittiPoses(const std::filesystem::path& path,
                          const std::vector<std::int64_t>& stamps_ns);

// Reads the times of a KITTI times.txt, in seconds, one in each row. Throws the errors of
// ReadTrajectory.
std::vector<std::int64_t> ReadKittiTimes(const std::filesystem::path& path);

// Returns a trajectory in TUM form: 9 decimals for the stamp, 9 for the rest; qw >= 0. It has no
// header. Throws InputError for a rotation that is none (geometry/unit_rotation.h).
std::string FormatTum(const Trajectory& trajectory);
// Throws WriteError, which names `file`, where WriteTum would not write this trajectory.
void CheckTum(const std::filesystem::path& file, const Trajectory& trajectory);
// Writes FormatTum(trajectory) to a file, whole or not at all. Throws InputError "cannot write
// <path>: ...", and also where ReadTrajectory would refuse the file: for stamps that do not
// increase or are beyond the year 2096, rotations that are none, and places that are not finite or
// more than 10^9 m away.
void WriteTum(const std::filesystem::path& path, const Trajectory& trajectory);

// Returns a time stamp as seconds with 9 decimals, exact: 1305031102175304000 ->
// "1305031102.175304000".
std::string FormatStamp(std::int64_t stamp_ns);

}  // namespace plumbline
