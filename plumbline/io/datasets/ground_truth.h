// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/stamp_order.h"

#include <filesystem>
#include <vector>

namespace plumbline {

// Value of DatasetOptions::ground_truth that disables ground truth.
constexpr const char* kNoGroundTruth = "none";

// Delivered ground truth of a data set: its files and frame.
struct DeliveredTruth {
  std::vector<std::filesystem::path> files = {};  // candidates: the first existing file is read
  GroundTruth::Frame frame = GroundTruth::Frame::kCamera;
  const std::vector<StampedRow>* times = nullptr;  // of the rows of KITTI poses
};

// Reads the ground truth of a data set into info.ground_truth: from the file named by the options,
// otherwise the delivered one, if any. Both are read in the formats of ReadTrajectory and are of
// the delivered frame; unusable rows are left out, with notes (BadRows::kLeaveOut).
//
// An unusable delivered file is not an error: its fault becomes info.ground_truth_fault. For a file
// named by the options the InputError is thrown. Poses of a body need
// info.calibration.body_from_left, which must have been read before.
void AddGroundTruth(const DeliveredTruth& delivered,
                    const DatasetOptions& options,
                    DatasetInfo& info);

}  // namespace plumbline
