// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/trajectory.h"
#include "plumbline/io/stamp_order.h"

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

// What becomes of rows of a trajectory file that cannot be used.
enum class BadRows {
  kRefuse,    // the file is an error: an estimate is as its program wrote it, or not to be trusted
  kLeaveOut,  // they are left out, with a note: references have gaps, and are made by hand
};

// A trajectory and the format of its file.
struct LoadedTrajectory {
  TrajectoryFormat format = TrajectoryFormat::kTum;
  // Poses of the frame that the file is about, in order of time.
  Trajectory poses;
  // One sentence for each kind of rows that are left out: the file, how many, the first line.
  std::vector<std::string> notes = {};
};

// Reads a trajectory and finds out its format from the first row. KITTI rows take their times from
// `times`, or where that is null from times.txt beside the file or, as distributed (poses/06.txt),
// ../sequences/06/times.txt. Times of KITTI that are repeated or unsorted are left out or sorted,
// with their poses. Quaternions are normalized.
//
// Throws InputError "path:line: expected ..., found ..." for a quaternion whose norm differs from 1
// by more than 0.01, a matrix that is not a rotation (to 1e-3), times that do not increase, a file
// without rows, and any malformed row. With kLeaveOut such rows are left out, also those before the
// first one that has the form of a pose (a header); what is thrown then is where no row is left,
// with the fault of the first one, where the file cannot be read, and where there are more or fewer
// rows of KITTI than times.
LoadedTrajectory ReadTrajectory(const std::filesystem::path& path,
                                BadRows bad_rows = BadRows::kRefuse,
                                const std::vector<StampedRow>* times = nullptr);

// Reads the times of a KITTI times.txt, in seconds, one in each row, in the order of the file,
// which need not be that of time (OrderOfTime). Throws the errors of ReadTrajectory.
std::vector<StampedRow> ReadKittiTimes(const std::filesystem::path& path);

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
