// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/datasets/dataset.h"
#include "plumbline/report/trajectory_error.h"
#include "plumbline/slam/run_result.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// Resources used by a run since its start.
struct ResourceUse {
  double wall_seconds = 0;
  std::optional<double> first_pose_seconds;  // from the start of the process; nullopt: no pose
  double cpu_seconds = 0;
  double peak_memory_mb = 0;
};

// Returns CPU time and peak memory of this process; the caller sets the other times.
ResourceUse MeasureResources();

// Returns the time since the start of this process, including its loading, to 10 ms; nullopt if the
// system does not report it.
std::optional<double> SecondsSinceProcessStart();

struct RunCounts {
  int frames = 0, tracked = 0, lost = 0, skipped = 0, initializing = 0;
  // Tracked frames in the main map: the poses of trajectory.txt.
  int in_trajectory = 0;
  // Frames skipped in a live run for lack of time.
  int dropped = 0;
  // Frames of a live run with reduced work, by the last reduction, in the order of LoadLevel.
  int shed_mapping = 0, shed_lines = 0, shed_points = 0;
  int demoted = 0;  // keyframes dropped because mapping was busy
  int keyframes = 0, points = 0, lines = 0, maps = 0;
};
RunCounts CountRun(const RunResult& result);

// Mean memory of a line landmark in bytes; nullopt without lines.
struct LineMemory {
  // Bytes of a line in the main map: position, information, appearance and its list of
  // observations.
  std::optional<double> map;
  // Bytes of a line in local bundle adjustment, over all windows of the run: parameters,
  // observations and equations.
  std::optional<double> adjustment;
};
LineMemory MeasureLineMemory(const RunResult& result);

// Returns a sentence on what the gyroscope took part in, and what its calibration lacks as the run
// found it; nullopt where no turn of it was compared with the camera's.
std::optional<std::string> DescribeGyroscope(const RunResult& result);

// Returns the reason why CompareWithGroundTruth has no errors for a run on this data: "no ground
// truth with the data", or the file and line at fault.
std::string WhyNoErrors(const DatasetInfo& info);

// Compares the final trajectory of a map, or of the main map, with the data set's ground truth:
// SE(3) alignment, Sim(3) for mono, windows of 3 s. Returns nullopt without ground truth or
// trajectory, and where fewer than three poses have ground truth.
std::optional<TrajectoryError> CompareWithGroundTruth(const RunResult& result,
                                                      const Dataset& dataset,
                                                      MapId map);
std::optional<TrajectoryError> CompareWithGroundTruth(const RunResult& result,
                                                      const Dataset& dataset);

struct RunDescription {
  std::string version;
  std::string data_path;
  std::string options_yaml;
  int seed = 0;
  std::vector<std::string> arguments = {};  // arguments of the command
  std::size_t frames_chosen = 0;            // frames to be processed
  // Name of the signal that ended the run early, "SIGINT"; nullopt if none did.
  std::optional<std::string> interrupted = std::nullopt;
  // Name of the preset that the options begin with (slam/preset.h); nullopt: the defaults.
  std::optional<std::string> preset = std::nullopt;
  // One sentence for each fault of the data found in the images.
  std::vector<std::string> notes = {};
};

// Returns the notes of the data set and those of the run.
std::vector<std::string> NotesOf(const RunDescription& description, const Dataset& dataset);

// Returns the text of summary.json.
std::string FormatSummary(const RunDescription& description,
                          const RunResult& result,
                          const Dataset& dataset,
                          const ResourceUse& resources);

}  // namespace plumbline
