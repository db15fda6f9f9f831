// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/trajectory.h"
#include "plumbline/io/datasets/stamp_order.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace plumbline {

// Format of the rows of a trajectory file.
enum class TrajectoryFormat {
  kTum,    // `seconds tx ty tz qx qy qz qw`, blanks between, # comments
  kEuroc,  // CSV `nanoseconds,px,py,pz,qw,qx,qy,qz,...`; more columns are ignored
  kKitti,  // 12 numbers a row, a 3x4 matrix; times in a separate file
};

// Treatment of unusable rows of a trajectory file.
enum class BadRows {
  kRefuse,    // the file is an error: an estimate is as its program wrote it, or not to be trusted
  kLeaveOut,  // they are left out, with a note: references have gaps, and are made by hand
};

// A trajectory and the format of its file.
struct LoadedTrajectory {
  TrajectoryFormat format = TrajectoryFormat::kTum;
  // Poses of the frame of the file, in order of time.
  Trajectory poses;
  // One sentence for each kind of rows left out: the file, their number, the first line.
  std::vector<std::string> notes = {};
};

// Reads a trajectory and detects its format from the first row. KITTI rows take their times from
// `times`, or if that is null from times.txt beside the file or, as distributed (poses/06.txt),
// ../sequences/06/times.txt. Times of KITTI that are repeated or unsorted are left out or sorted,
// with their poses. Quaternions are normalized.
//
// Throws InputError "path:line: expected ..., found ..." for a quaternion whose norm differs from 1
// by more than 0.01, a matrix that is not a rotation (to 1e-3), times that do not increase, a file
// without rows, and any malformed row. With kLeaveOut such rows are left out, also those before the
// first one that has the form of a pose (a header); it then throws only if no row is left, with the
// fault of the first one, if the file cannot be read, and if there are more or fewer rows of KITTI
// than times.
LoadedTrajectory ReadTrajectory(const std::filesystem::path& path,
                                BadRows bad_rows = BadRows::kRefuse,
                                const std::vector<StampedRow>* times = nullptr);

// Reads the times of a KITTI times.txt, in seconds, one in each row, in the order of the file,
// which need not be that of time (OrderOfTime). Throws the errors of ReadTrajectory.
std::vector<StampedRow> ReadKittiTimes(const std::filesystem::path& path);

// Returns a trajectory in TUM form: 9 decimals for the stamp, 9 for the rest; qw >= 0. It has no
// header. Throws InputError for an invalid rotation (UnitRotation).
std::string FormatTum(const Trajectory& trajectory);
// Throws WriteError, which names `file`, if WriteTum would not write this trajectory.
void CheckTum(const std::filesystem::path& file, const Trajectory& trajectory);
// Writes FormatTum(trajectory) to a file, whole or not at all. Throws InputError "cannot write
// <path>: ...", and also if ReadTrajectory would refuse the file: for stamps that do not increase
// or are beyond the year 2096, invalid rotations, and positions that are not finite or more than
// 10^9 m away.
void WriteTum(const std::filesystem::path& path, const Trajectory& trajectory);

// Returns a time stamp as seconds with 9 decimals, exact: 1305031102175304000 ->
// "1305031102.175304000".
std::string FormatStamp(std::int64_t stamp_ns);

}  // namespace plumbline
