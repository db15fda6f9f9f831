// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_maps/run_line_map.h"

#include "lab/line_maps/run_trajectory.h"
#include "plumbline/base/error.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/io/export/obj_lines.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/io/trajectory_io.h"
#include "worlds/true_world.h"

#include <cstdint>
#include <system_error>
#include <utility>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

bool IsFile(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

// nullopt if the run has no list of its keyframes.
std::optional<LineViewers> KeyFrameViewers(const fs::path& sequence,
                                           const fs::path& run,
                                           const TrajectoryError& trajectory) {
  if (!IsFile(run / "keyframes.txt")) return std::nullopt;
  const auto dataset = OpenDataset(sequence);
  std::vector<std::int64_t> stamps;
  for (const StampedPose& pose : ReadTrajectory(run / "keyframes.txt").poses) {
    stamps.push_back(pose.stamp_ns);
  }
  return ViewersOf(
      dataset->calibration().left, dataset->info().stamps_ns, stamps, trajectory.poses);
}

}  // namespace

std::optional<RunLineMap> ReadRunLineMap(const fs::path& sequence,
                                         const fs::path& run,
                                         const fs::path& file) {
  auto trajectory = CompareRunWithTruth(sequence, run);
  if (!trajectory) return std::nullopt;
  RunLineMap map;
  map.trajectory = *std::move(trajectory);
  map.truth = ReadTrueLines(sequence / "lines.csv");
  if (IsFile(sequence / "surfaces.csv")) map.surfaces = ReadSurfaces(sequence / "surfaces.csv");
  map.viewers = KeyFrameViewers(sequence, run, map.trajectory);
  map.lines = ReadLinesInTrueWorld(file, map.trajectory);
  return map;
}

Similarity3 TrueWorldFromRun(const TrajectoryError& trajectory) {
  return AlignPoses(trajectory.poses) * trajectory.reference_from_estimate;
}

std::vector<Segment3> ReadLineMap(const fs::path& path) {
  if (path.extension() == ".obj") return ReadObjLines(path);
  if (path.extension() != ".plb") {
    throw InputError(path.string() + ": expected a file name ending in .obj or .plb");
  }
  std::vector<Segment3> segments;
  const SavedMap saved = LoadMap(path);
  for (const auto& [id, line] : saved.map.lines()) segments.push_back(line.Interval());
  return segments;
}

std::vector<Segment3> ReadLinesInTrueWorld(const fs::path& file,
                                           const TrajectoryError& trajectory) {
  const Similarity3 true_from_run = TrueWorldFromRun(trajectory);
  std::vector<Segment3> segments = ReadLineMap(file);
  for (Segment3& segment : segments) {
    segment = {true_from_run * segment.start, true_from_run * segment.end};
  }
  return segments;
}

}  // namespace plumbline
