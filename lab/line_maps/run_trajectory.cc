// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_maps/run_trajectory.h"

#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/report/error_options.h"

#include <string>
#include <system_error>

#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

// Returns the sensor of a run; kStereo stands for all sensors that measure depth.
SensorKind SensorOf(const fs::path& run) {
  const auto summary = nlohmann::json::parse(ReadInputFile(run / "summary.json"), nullptr, false);
  const bool mono =
      summary.is_object() && summary.contains("sensor") && summary["sensor"] == "mono";
  return mono ? SensorKind::kMono : SensorKind::kStereo;
}

}  // namespace

std::optional<TrajectoryError> CompareRunWithTruth(const fs::path& sequence, const fs::path& run) {
  std::error_code error;
  if (!fs::exists(run / "trajectory.txt", error) || fs::file_size(run / "trajectory.txt") == 0) {
    return std::nullopt;
  }
  DatasetOptions data_options;
  data_options.allow_missing_camera = true;
  const auto dataset = OpenDataset(sequence, data_options);
  if (!dataset->info().ground_truth) return std::nullopt;
  const TrajectoryErrorOptions options = ErrorOptionsFor(SensorOf(run), dataset->info().format);
  return CompareTrajectories(dataset->info().ground_truth->OfCamera(dataset->calibration()),
                             ReadTrajectory(run / "trajectory.txt").poses,
                             options);
}

}  // namespace plumbline
