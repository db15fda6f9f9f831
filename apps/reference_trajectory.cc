// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/reference_trajectory.h"

#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/dataset_formats.h"
#include "plumbline/io/text_rows.h"
#include "plumbline/report/run_folder.h"
#include "plumbline/report/trajectory_error.h"

#include <set>
#include <string>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

bool IsFile(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

fs::path GroundTruthFile(const fs::path& path) {
  CheckExists(path, "file or folder");
  std::error_code error;
  if (!fs::is_directory(path, error)) return path;
  const fs::path euroc = fs::path("state_groundtruth_estimate0") / "data.csv";
  for (const fs::path& name : {"mav0" / euroc, euroc, fs::path("groundtruth.txt")}) {
    if (IsFile(path / name)) return path / name;
  }
  for (const fs::path& file : KittiPosesFiles(path)) {
    if (IsFile(file)) return file;
  }
  throw InputError(path.string() +
                   ": expected ground truth (mav0/state_groundtruth_estimate0/data.csv, "
                   "groundtruth.txt, poses.txt or KITTI's ../../poses/NUMBER.txt), found none");
}

// Counts the rows that begin with a number, each number once.
std::optional<std::size_t> RowsWithNumbers(const fs::path& path, char separator) {
  if (!IsFile(path)) return std::nullopt;
  std::set<std::string> numbers;
  for (const TextRow& row : ReadRows(path, separator)) {
    if (ParseNumber(row.fields.front())) numbers.insert(row.fields.front());
  }
  return numbers.size();
}

std::optional<std::size_t> FramesBeside(const ReferenceTrajectory& reference) {
  const fs::path folder = reference.path.parent_path();
  switch (reference.format) {
    case TrajectoryFormat::kEuroc:
      return RowsWithNumbers(folder.parent_path() / "cam0" / "data.csv", ',');
    case TrajectoryFormat::kTum:
      return RowsWithNumbers(folder / "rgb.txt", ' ');
    case TrajectoryFormat::kKitti:
      return ReadRows(reference.path, ' ').size();
  }
  return std::nullopt;
}

// The folder of the run that wrote this trajectory; nullopt: none. A copied trajectory may lie
// beside files of other runs: the list of the run's files determines whether it is one of them.
// Without a list, for example in a folder with copies of some results, its name does.
std::optional<fs::path> FolderOfItsRun(const fs::path& trajectory) {
  const fs::path folder = fs::absolute(trajectory).parent_path();
  try {
    const auto list = ReadRunList(folder);  // a killed run has none
    const std::string name = trajectory.filename().string();
    const bool its = list ? std::binary_search(list->begin(), list->end(), name) : IsRunFile(name);
    return its ? std::optional(folder) : std::nullopt;
  } catch (const InputError&) {  // something else of that name
    return std::nullopt;
  }
}

}  // namespace

ReferenceTrajectory LoadReference(const fs::path& path, std::optional<ReferenceFrame> frame) {
  ReferenceTrajectory reference;
  reference.path = fs::absolute(GroundTruthFile(path));
  LoadedTrajectory loaded = ReadTrajectory(GroundTruthFile(path), BadRows::kLeaveOut);
  reference.format = loaded.format;
  reference.notes = std::move(loaded.notes);
  reference.poses = std::move(loaded.poses);
  reference.frames = FramesBeside(reference);
  const bool euroc = reference.format == TrajectoryFormat::kEuroc;
  if (frame.value_or(euroc ? ReferenceFrame::kBody : ReferenceFrame::kCamera) ==
      ReferenceFrame::kCamera) {
    return reference;
  }
  const fs::path sensor = reference.path.parent_path().parent_path() / "cam0" / "sensor.yaml";
  if (!IsFile(sensor)) {
    throw InputError(path.string() + ": expected " + sensor.string() +
                     " to convert the poses of the body to the camera, found no such file "
                     "(--reference-frame camera takes them as they are)");
  }
  reference.poses = OfCamera(reference.poses, ReadEurocSensor(sensor).body_from_camera);
  return reference;
}

std::optional<std::size_t> FramesOfRun(const fs::path& trajectory) {
  const auto folder = FolderOfItsRun(trajectory);
  return folder ? RowsWithNumbers(*folder / "frames.csv", ',') : std::nullopt;
}

bool IsMonocularRun(const fs::path& trajectory) {
  const auto folder = FolderOfItsRun(trajectory);
  if (!folder || !IsFile(*folder / "summary.json")) return false;
  const auto json = nlohmann::json::parse(ReadInputFile(*folder / "summary.json"), nullptr, false);
  return json.is_object() && json.contains("sensor") && json["sensor"] == "mono";
}

}  // namespace plumbline
