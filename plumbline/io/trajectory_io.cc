// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/trajectory_io.h"

#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/text_rows.h"

#include <cmath>
#include <cstdlib>
#include <optional>
#include <system_error>
#include <utility>

#include <Eigen/LU>
#include <fmt/core.h>

namespace plumbline {
namespace {

using std::filesystem::path;

std::string Count(std::size_t count) { return std::to_string(count) + " columns"; }

// Returns the quaternion whose components are in the given columns.
Eigen::Quaterniond QuaternionAt(const path& file,
                                const TextRow& row,
                                std::size_t w,
                                std::size_t x) {
  const Eigen::Vector3d v = PlaceFields(file, row, x);
  const Eigen::Quaterniond q(NumberField(file, row, w), v.x(), v.y(), v.z());
  if (!IsRotation(q)) {
    FailAt(file, row.line, "a unit quaternion", fmt::format("one of norm {:.6g}", q.norm()));
  }
  return q.normalized();
}

std::int64_t Stamp(const path& file, const TextRow& row, TrajectoryFormat format) {
  const bool seconds = format == TrajectoryFormat::kTum;
  const std::string& text = row.fields[0];
  // A trajectory may have times before zero, which no sensor has.
  const bool negative = text.starts_with('-');
  const std::string_view digits = std::string_view(text).substr(negative ? 1 : 0);
  const std::optional<std::int64_t> stamp =
      seconds ? ParseSeconds(digits) : ParseNanoseconds(digits);
  if (!stamp) {
    FailAt(file,
           row.line,
           seconds ? "a time stamp in seconds" : "a time stamp in whole nanoseconds",
           InQuotes(text));
  }
  return negative ? -*stamp : *stamp;
}

Rigid3 PoseOfRow(const path& file, const TextRow& row, TrajectoryFormat format) {
  if (format == TrajectoryFormat::kTum) {
    return {QuaternionAt(file, row, 7, 4), PlaceFields(file, row, 1)};
  }
  return {QuaternionAt(file, row, 4, 5), PlaceFields(file, row, 1)};
}

Rigid3 PoseOfMatrixRow(const path& file, const TextRow& row) {
  if (row.fields.size() != 12) {
    FailAt(file, row.line, "12 numbers, a 3x4 matrix", Count(row.fields.size()));
  }
  Eigen::Matrix3d rotation;
  const Eigen::Vector3d translation = PlaceFields(file, row, 3, 4);
  for (std::size_t r = 0; r < 3; ++r) {
    const auto i = static_cast<Eigen::Index>(r);
    rotation.row(i) = PlaceFields(file, row, 4 * r).transpose();
  }
  const double off = (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm();
  if (off > 1e-3 || rotation.determinant() < 0) {
    FailAt(
        file,
        row.line,
        "a rotation matrix",
        fmt::format(
            "R R^T off the identity by {:.3g}, determinant {:.6g}", off, rotation.determinant()));
  }
  return {Eigen::Quaterniond(rotation).normalized(), translation};
}

// The poses of rows that are looked at one by one, and the rows that give none.
class PoseRows {
 public:
  PoseRows(path file, BadRows bad_rows) : file_(std::move(file)), bad_rows_(bad_rows) {}

  // Calls `add`, which reads the row, and counts the row if it is unusable.
  template <typename Add>
  void Take(const TextRow& row, const Add& add) {
    if (bad_rows_ == BadRows::kRefuse) return add();
    try {
      add();
    } catch (const InputError& error) {
      if (malformed_.count == 0) first_fault_ = error.what();
      malformed_.Add(row.line);
    }
  }

  // Appends a pose. Fails, or counts the row, if its time does not increase.
  void Append(const TextRow& row, const StampedPose& pose) {
    const auto previous = poses_.empty() ? std::nullopt : std::optional(poses_.back().stamp_ns);
    if (bad_rows_ == BadRows::kRefuse) CheckStampOrder(file_, row.line, previous, pose.stamp_ns);
    if (previous && pose.stamp_ns <= *previous) {
      (pose.stamp_ns == *previous ? repeated_ : unsorted_).Add(row.line);
      return;
    }
    poses_.push_back(pose);
  }

  LoadedTrajectory Finish(TrajectoryFormat format) {
    std::vector<std::string> notes;
    if (poses_.empty() && malformed_.count > 0) throw InputError(first_fault_);
    NoteLeftOut(file_, repeated_, unsorted_, notes);
    if (malformed_.count > 0) {
      notes.push_back(
          first_fault_ +
          (malformed_.count == 1
               ? "; this row is left out"
               : fmt::format("; {} rows that cannot be used are left out", malformed_.count)));
    }
    return {format, std::move(poses_), std::move(notes)};
  }

 private:
  path file_;
  BadRows bad_rows_;
  Trajectory poses_;
  FaultyRows repeated_, unsorted_, malformed_;
  std::string first_fault_;
};

StampedPose ReadPose(const path& file, const TextRow& row, TrajectoryFormat format) {
  const bool tum = format == TrajectoryFormat::kTum;
  if (tum ? row.fields.size() != 8 : row.fields.size() < 8) {
    FailAt(file,
           row.line,
           tum ? "8 columns (time tx ty tz qx qy qz qw)"
               : "at least 8 columns (time,px,py,pz,qw,qx,qy,qz)",
           Count(row.fields.size()));
  }
  const std::int64_t stamp = Stamp(file, row, format);
  return {stamp, PoseOfRow(file, row, format)};
}

LoadedTrajectory ReadStamped(const path& file, TrajectoryFormat format, BadRows bad_rows) {
  PoseRows poses(file, bad_rows);
  for (const TextRow& row : ReadRows(file, format == TrajectoryFormat::kTum ? ' ' : ',')) {
    poses.Take(row, [&] { poses.Append(row, ReadPose(file, row, format)); });
  }
  return poses.Finish(format);
}

// Reads the rows of a KITTI poses file, each of which has the time in the same row of `times`.
LoadedTrajectory ReadKitti(const path& file,
                           const std::vector<StampedRow>& times,
                           const std::vector<std::size_t>& order,
                           BadRows bad_rows) {
  const std::vector<TextRow> rows = ReadRows(file, ' ');
  if (rows.size() != times.size()) {
    throw InputError(file.string() + ": expected " + std::to_string(times.size()) +
                     " poses, one for each time, found " + std::to_string(rows.size()));
  }
  PoseRows poses(file, bad_rows);
  for (const std::size_t i : order) {
    poses.Take(rows[i], [&] {
      poses.Append(rows[i], {times[i].stamp_ns, PoseOfMatrixRow(file, rows[i])});
    });
  }
  return poses.Finish(TrajectoryFormat::kKitti);
}

std::optional<TrajectoryFormat> FormatOf(const TextRow& row) {
  for (const std::string& field : row.fields) {
    if (field.find(',') != std::string::npos) return TrajectoryFormat::kEuroc;
  }
  if (row.fields.size() == 12) return TrajectoryFormat::kKitti;
  if (row.fields.size() == 8) return TrajectoryFormat::kTum;
  return std::nullopt;
}

// Returns true if the row begins with a number, unlike names of columns.
bool BeginsWithNumber(const TextRow& row) {
  return ParseNumber(std::string_view(row.fields[0]).substr(0, row.fields[0].find(',')))
      .has_value();
}

TrajectoryFormat FormatOf(const path& file, BadRows bad_rows) {
  const std::vector<TextRow> rows = ReadRows(file, ' ');
  if (rows.empty()) throw InputError(file.string() + ": expected poses, found no rows");
  if (bad_rows == BadRows::kLeaveOut) {
    for (const TextRow& row : rows) {
      const auto format = FormatOf(row);
      if (format && BeginsWithNumber(row)) return *format;
    }
  }
  const TextRow& row = rows.front();
  if (const auto format = FormatOf(row)) return *format;
  FailAt(file,
         row.line,
         "8 columns (TUM), 12 (KITTI) or commas between them (EuRoC)",
         Count(row.fields.size()));
}

// Returns the file of the times of a KITTI poses file.
path KittiTimesFile(const path& file) {
  const path beside = file.parent_path() / "times.txt";
  const path distributed = file.parent_path() / ".." / "sequences" / file.stem() / "times.txt";
  std::error_code error;
  const bool is_distributed =
      !std::filesystem::exists(beside, error) && std::filesystem::exists(distributed, error);
  return is_distributed ? distributed : beside;
}

// Returns the fault of pose i for ReadTrajectory; nullopt if it is accepted.
std::optional<std::string> FaultOf(const Trajectory& trajectory, std::size_t i) {
  const std::int64_t stamp_ns = trajectory[i].stamp_ns;
  if (!IsReadableStamp(stamp_ns)) {
    return fmt::format(
        "expected a time stamp within {} ns of 0, found {}", kLatestStampNs, stamp_ns);
  }
  if (i > 0 && stamp_ns <= trajectory[i - 1].stamp_ns) {
    return fmt::format("expected ascending time stamps, found {} ns after {} ns",
                       stamp_ns,
                       trajectory[i - 1].stamp_ns);
  }
  if (const Eigen::Quaterniond& q = trajectory[i].world_from_camera.rotation; !IsRotation(q)) {
    return fmt::format("expected a quaternion of norm 1, found one of norm {:g}", q.norm());
  }
  for (const double x : trajectory[i].world_from_camera.translation) {
    if (std::abs(x) <= kFarthest) continue;  // false for NaN
    return fmt::format("expected coordinates within {:g} of 0, found {:g}", kFarthest, x);
  }
  return std::nullopt;
}

// Returns a number with fixed decimals, without a minus sign before zero.
std::string Fixed(double value) {
  std::string text = fmt::format("{:.9f}", value);
  if (text == "-0.000000000") text.erase(0, 1);
  return text;
}

}  // namespace

LoadedTrajectory ReadTrajectory(const path& file,
                                BadRows bad_rows,
                                const std::vector<StampedRow>* times) {
  const TrajectoryFormat format = FormatOf(file, bad_rows);
  if (format != TrajectoryFormat::kKitti) return ReadStamped(file, format, bad_rows);
  std::vector<std::string> notes;
  if (times != nullptr) {
    // Whoever has read the times has told of them.
    return ReadKitti(file, *times, OrderOfTime({}, *times, notes), bad_rows);
  }
  const path times_file = KittiTimesFile(file);
  const std::vector<StampedRow> rows = ReadKittiTimes(times_file);
  const std::vector<std::size_t> order = OrderOfTime(times_file, rows, notes);
  LoadedTrajectory loaded = ReadKitti(file, rows, order, bad_rows);
  loaded.notes.insert(loaded.notes.begin(), notes.begin(), notes.end());
  return loaded;
}

std::vector<StampedRow> ReadKittiTimes(const path& file) {
  std::vector<StampedRow> times;
  for (const TextRow& row : ReadRows(file, ' ')) {
    if (row.fields.size() != 1) FailAt(file, row.line, "one time", Count(row.fields.size()));
    times.push_back({Stamp(file, row, TrajectoryFormat::kTum), row.line});
  }
  if (times.empty()) throw InputError(file.string() + ": expected times, found no rows");
  return times;
}

std::string FormatStamp(std::int64_t stamp_ns) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  return fmt::format("{}{}.{:09}",
                     stamp_ns < 0 ? "-" : "",
                     std::abs(stamp_ns / kSecond),
                     std::abs(stamp_ns % kSecond));
}

std::string FormatTum(const Trajectory& trajectory) {
  std::string text;
  for (const StampedPose& pose : trajectory) {
    Eigen::Vector4d q = UnitRotation(pose.world_from_camera.rotation, "a pose").coeffs();
    if (q.w() < 0) q = -q;
    const Eigen::Vector3d& t = pose.world_from_camera.translation;
    text += FormatStamp(pose.stamp_ns);
    for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
      text += ' ';
      text += Fixed(value);
    }
    text += '\n';
  }
  return text;
}

void CheckTum(const path& file, const Trajectory& trajectory) {
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    if (const auto fault = FaultOf(trajectory, i)) {
      throw WriteError(file, fmt::format("pose {} (from 0): {}", i, *fault));
    }
  }
}

void WriteTum(const path& file, const Trajectory& trajectory) {
  CheckTum(file, trajectory);
  WriteFileAtomically(file, FormatTum(trajectory));
}

}  // namespace plumbline
