// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/line_map_input.h"

#include "plumbline/base/error.h"
#include "plumbline/io/dataset.h"
#include "plumbline/io/line_map_file.h"
#include "plumbline/io/open_dataset.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/io/true_world.h"

#include <cstdint>
#include <string>
#include <system_error>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

// The file that was named, else the one of that name in the folder, if there is one.
std::optional<fs::path> Find(const std::optional<fs::path>& named,
                             const fs::path& folder,
                             const std::string& name) {
  std::error_code error;
  if (named) return named;
  if (fs::is_regular_file(folder / name, error)) return folder / name;
  return std::nullopt;
}

}  // namespace

std::optional<LineMapInput> LoadLineMaps(const LineMapFiles& files) {
  const auto truth = Find(files.true_lines, files.reference, "lines.csv");
  const auto surfaces = Find(files.surfaces, files.reference, "surfaces.csv");
  const auto lines = Find(files.lines, files.estimate, "lines.obj");
  const bool wanted = files.true_lines || files.lines || files.surfaces;
  if (wanted && !truth) {
    throw InputError(files.reference.string() +
                     ": expected lines.csv to compare lines with, found none (--true-lines FILE "
                     "names one)");
  }
  if (wanted && !lines) {
    throw InputError(files.estimate.string() +
                     ": expected lines.obj to compare with the true lines, found none (--lines "
                     "FILE names one)");
  }
  if (!truth || !lines) return std::nullopt;
  LineMapInput input;
  input.truth = ReadTrueLines(*truth);
  if (files.true_lines && input.truth.empty()) {
    throw InputError(truth->string() + ": expected lines, found no rows");
  }
  if (surfaces) input.surfaces = ReadSurfaces(*surfaces);
  input.estimate = ReadLineMap(*lines);
  return input;
}

std::optional<LineViewers> LoadLineViewers(const LineMapFiles& files,
                                           std::span<const EvaluatedPose> poses) {
  std::error_code error;
  const fs::path keyframes = files.estimate / "keyframes.txt";
  if (!fs::is_regular_file(keyframes, error) || !fs::is_directory(files.reference, error) ||
      !FindFormat(files.reference)) {
    return std::nullopt;
  }
  const auto dataset = OpenDataset(files.reference);
  std::vector<std::int64_t> stamps;
  for (const StampedPose& pose : ReadTrajectory(keyframes).poses) stamps.push_back(pose.stamp_ns);
  return ViewersOf(dataset->calibration().left, dataset->info().stamps_ns, stamps, poses);
}

void MirrorWorldY(LineMapInput& input) {
  for (TrueLine& line : input.truth) {
    line.segment.start.y() *= -1;
    line.segment.end.y() *= -1;
  }
  for (Parallelogram& surface : input.surfaces) {
    surface.origin.y() *= -1;
    surface.side_u.y() *= -1;
    surface.side_v.y() *= -1;
  }
}

std::vector<Segment3> Transformed(const Similarity3& target_from_source,
                                  std::vector<Segment3> segments) {
  for (Segment3& segment : segments) {
    segment = {target_from_source * segment.start, target_from_source * segment.end};
  }
  return segments;
}

}  // namespace plumbline
