// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/line_map_figures.h"

#include "lab/experiments/run_trajectory.h"
#include "plumbline/base/error.h"
#include "plumbline/eval/line_map_error.h"
#include "plumbline/eval/trajectory_error.h"
#include "plumbline/io/dataset.h"
#include "plumbline/io/obj_lines.h"
#include "plumbline/io/open_dataset.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/io/true_world.h"

#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr double kTolerance = 0.05;  // metres

// nullopt where the run left no list of its keyframes.
std::optional<LineViewers> KeyFrameViewers(const Dataset& dataset,
                                           const fs::path& run,
                                           const TrajectoryError& trajectory) {
  std::error_code error;
  if (!fs::exists(run / "keyframes.txt", error)) return std::nullopt;
  std::vector<std::int64_t> stamps;
  for (const StampedPose& pose : ReadTrajectory(run / "keyframes.txt").poses) {
    stamps.push_back(pose.stamp_ns);
  }
  return ViewersOf(dataset.calibration().left, dataset.info().stamps_ns, stamps, trajectory.poses);
}

LineMapErrorAt Compare(const Dataset& dataset,
                       const fs::path& run,
                       const TrajectoryError& trajectory) {
  const fs::path& sequence = dataset.info().path;
  const Similarity3 reference_from_estimate =
      AlignPoses(trajectory.poses) * trajectory.reference_from_estimate;
  std::vector<Segment3> segments = ReadObjLines(run / "lines.obj");
  for (Segment3& segment : segments) {
    segment.start = reference_from_estimate * segment.start;
    segment.end = reference_from_estimate * segment.end;
  }
  std::vector<Parallelogram> surfaces;
  if (fs::exists(sequence / "surfaces.csv")) surfaces = ReadSurfaces(sequence / "surfaces.csv");
  LineMapErrorOptions options;
  options.tolerances = {kTolerance};
  options.viewers = KeyFrameViewers(dataset, run, trajectory);
  return CompareLineMaps(ReadTrueLines(sequence / "lines.csv"), segments, surfaces, options).at[0];
}

}  // namespace

void AddLineMapFigures(const fs::path& sequence, const fs::path& run, RunFigures& figures) {
  constexpr double kPercent = 100, kMillimetres = 1000, kDegrees = 180 / std::numbers::pi;
  const auto add = [&](const char* name, double factor, const std::optional<double>& value) {
    figures.reasons.erase(name);
    if (value) {
      figures.values[name] = factor * *value;
    } else {
      figures.reasons[name] = "no line has a counterpart";
    }
  };
  std::error_code error;
  if (!fs::exists(sequence / "lines.csv", error)) return;
  // An empty trajectory is no file to be read.
  const auto coverage = figures.values.find("coverage");
  if (coverage == figures.values.end() || coverage->second == 0) return;
  try {
    const auto dataset = OpenDataset(sequence);
    const auto trajectory = CompareRunWithTruth(sequence, run);
    if (!trajectory) return;
    const LineMapErrorAt at = Compare(*dataset, run, *trajectory);
    add("line_recall", kPercent, at.recall);
    add("line_precision", kPercent, at.precision);
    add("line_angle", kDegrees, at.median_angle);
    add("line_distance", kMillimetres, at.median_distance);
    add("line_multiplicity", 1, at.multiplicity);
  } catch (const InputError&) {
    for (const Metric& metric : Metrics()) {
      if (metric.name.starts_with("line_")) {
        figures.reasons[std::string(metric.name)] = "the lines cannot be read";
      }
    }
  }
}

}  // namespace plumbline
