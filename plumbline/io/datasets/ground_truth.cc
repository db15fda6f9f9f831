// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/ground_truth.h"

#include "plumbline/base/error.h"
#include "plumbline/io/datasets/image_dataset.h"
#include "plumbline/io/trajectory_io.h"

#include <new>
#include <utility>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

void Read(const fs::path& file, const DeliveredTruth& delivered, DatasetInfo& info) {
  LoadedTrajectory loaded = ReadTrajectory(file, BadRows::kLeaveOut, delivered.times);
  if (delivered.frame == GroundTruth::Frame::kBody && !info.calibration.body_from_left) {
    throw InputError(file.string() +
                     ": expected body_from_left in the camera file, since these are poses of a "
                     "body, found none");
  }
  info.ground_truth = GroundTruth{std::move(loaded.poses), delivered.frame, file};
  info.notes.insert(info.notes.end(), loaded.notes.begin(), loaded.notes.end());
}

}  // namespace

void AddGroundTruth(const DeliveredTruth& delivered,
                    const DatasetOptions& options,
                    DatasetInfo& info) {
  if (options.ground_truth == kNoGroundTruth) return;
  if (options.ground_truth) return Read(*options.ground_truth, delivered, info);
  try {
    for (const fs::path& file : delivered.files) {
      if (PathExists(file)) return Read(file, delivered, info);
    }
  } catch (const InputError& error) {
    info.ground_truth_fault = error.what();
  } catch (const std::bad_alloc&) {
    info.ground_truth_fault = "the ground truth does not fit into memory";
  }
}

}  // namespace plumbline
